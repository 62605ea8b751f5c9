// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

#include <memory>
#include <vector>

#include "hgrid_proximity/broadphase/broad_phase.h"
#include "hgrid_proximity/broadphase/rooms.h"

namespace hgrid {

/// A layer above any broad phase, for cells and portals (Ericson, Real-Time Collision Detection, 2005, section 7.6). It
/// leaves out a pair if both boxes are in rooms but have no room in common. A box that is in no room keeps all its
/// pairs. Queries are not affected. Building explains the rules and how they differ from the book.
///
/// The boxes of the broad phase below and the building must be relative to the same frame. A layer cannot be copied or
/// moved, because the overlap filter of the broad phase below refers to it.
class RoomLayer final : public BroadPhase {
 public:
  /// @param below  an empty broad phase, not null; this is not checked. Its overlap filter is replaced.
  RoomLayer(Building building, std::unique_ptr<BroadPhase> below);
  RoomLayer(const RoomLayer&) = delete;
  RoomLayer& operator=(const RoomLayer&) = delete;

  /// Returns the rooms of a stored box, ascending. @throws std::invalid_argument if `id` is not stored
  const std::vector<std::uint32_t>& roomsOf(ProxyId id) const;
  /// Returns the rooms and portals.
  const Building& building() const { return building_; }

  void insert(ProxyId id, const Aabb& box) override;
  void update(ProxyId id, const Aabb& box) override;
  void remove(ProxyId id) override;
  void clear() override;
  void update(const std::vector<ProxyId>& ids, const std::vector<Aabb>& boxes) override;
  void move(const std::vector<ProxyId>& ids, const std::vector<Aabb>& boxes) override;
  void setFixed(const std::vector<ProxyId>& ids) override { below_->setFixed(ids); }
  void setOverlapFilter(const OverlapFilter& filter) override;
  void setPairBound(const PairBound& bound) override { below_->setPairBound(bound); }

  std::size_t size() const override { return below_->size(); }
  void overlappingPairs(std::vector<ProxyPair>& pairs) const override { below_->overlappingPairs(pairs); }
  bool boundedPairs(std::vector<ProxyPair>& pairs) const override { return below_->boundedPairs(pairs); }
  /// Searches along several segments at once.
  using BroadPhaseReader::along;
  /// Searches several spheres at once.
  using BroadPhaseReader::overlapping;
  void overlapping(const Aabb& box, std::vector<ProxyId>& found) const override { below_->overlapping(box, found); }
  void overlapping(const Sphere& sphere, std::vector<ProxyId>& found) const override {
    below_->overlapping(sphere, found);
  }
  void along(const Segment& segment, std::vector<SegmentHit>& found) const override { below_->along(segment, found); }
  void nearest(const Eigen::Vector3d& point, std::size_t count, double limit,
               std::vector<NearHit>& found) const override {
    below_->nearest(point, count, limit, found);
  }
  void prepareQueries() const override { below_->prepareQueries(); }
  std::vector<BroadPhaseLevel> levels() const override { return below_->levels(); }
  int levelOf(ProxyId id) const override { return below_->levelOf(id); }
  void checkInvariants() const override;

 private:
  struct Located {
    bool stored = false;  // whether the entry belongs to a stored box; in locatedMoved(): whether it was computed
    Aabb box;
    std::vector<std::uint32_t> rooms;  // ascending
  };
  static std::size_t keep(const void* layer, ProxyPair* pairs, std::size_t count);
  Located located(const Aabb& box) const;
  std::vector<Located> locatedMoved(const std::vector<ProxyId>& ids, const std::vector<Aabb>& boxes) const;
  void reserve(ProxyId id);

  Building building_;
  std::unique_ptr<BroadPhase> below_;
  OverlapFilter filter_;
  std::vector<Located> boxes_;  // by id
};

}  // namespace hgrid
