// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

#include <array>
#include <memory>
#include <string>
#include <vector>

#include "hgrid_proximity/broadphase/broad_phase.h"

namespace hgrid {

/// A wall of a convex room. The room is on the side of the points p with normal . p <= offset.
struct RoomWall {
  Eigen::Vector3d normal = Eigen::Vector3d::UnitX();  ///< any length but 0
  double offset = 0.0;                                ///< [m] times the length of `normal`
};

/// A convex room: the points that are on the inner side of all walls.
struct Room {
  std::string name;             ///< different from the names of all other rooms
  std::vector<RoomWall> walls;  ///< at least one

  /// Returns a room in the form of a box.
  static Room ofBox(const std::string& name, const Eigen::AlignedBox3d& box);
};

/// An opening between two rooms, such as a door or a window.
struct Portal {
  std::array<std::size_t, 2> rooms{};  ///< indices of two different rooms
  Eigen::AlignedBox3d opening;         ///< [m] contains the opening, through the whole thickness of the wall
};

/// The rooms and portals of a building (Ericson, Real-Time Collision Detection, 2005, section 7.6).
///
/// A box is in every room that it overlaps, and in both rooms of every portal that it overlaps. Two boxes can form a
/// pair only if they have a room in common. A box that is in no room can form a pair with any box: nothing is known
/// about its surroundings. So walls must be solid: two objects that meet inside a wall are not a pair.
///
/// A box counts as in a room unless it is entirely on the outer side of one wall. So a box that overlaps the room
/// always counts. A box outside of the room, near one of its corners, may also count.
///
/// Differs from the book, whose section is about rendering and adds collisions in a remark:
/// - A portal is a box and not a polygon. It contains the whole thickness of the wall, so an object inside the opening
///   is in both rooms.
/// - There is no traversal from room to room. To locate a box, roomsOf() tests all rooms and all portals.
/// - The book tests an object against the objects of its cells. Here a broad phase below finds all overlapping pairs,
///   and RoomLayer leaves out those without a common room.
class Building {
 public:
  static constexpr std::size_t kMostRooms = 4096;  ///< largest number of rooms

  /// @throws std::invalid_argument for a room without walls, a wall that is not finite or has no normal, a repeated
  ///   name, a portal to itself or to a room that does not exist, an empty opening, or too many rooms
  Building(std::vector<Room> rooms, std::vector<Portal> portals);

  /// Returns the rooms. Their indices are those of the constructor.
  const std::vector<Room>& rooms() const { return rooms_; }
  /// Returns the portals, in the order of the constructor.
  const std::vector<Portal>& portals() const { return portals_; }
  /// Replaces `found` with the indices of the rooms that a box is in, ascending.
  void roomsOf(const Aabb& box, std::vector<std::uint32_t>& found) const;

 private:
  std::vector<Room> rooms_;
  std::vector<Portal> portals_;
};

/// A layer above any broad phase: it leaves out pairs of boxes without a common room. Queries are not affected.
///
/// The boxes of the broad phase below and the building must be relative to the same frame. A layer cannot be copied or
/// moved, because the overlap filter of the broad phase below refers to it.
class RoomLayer final : public BroadPhase {
 public:
  /// @param below  an empty broad phase
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
  using BroadPhaseReader::along;
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
  std::vector<BroadPhaseLevel> levels() const override { return below_->levels(); }
  int levelOf(ProxyId id) const override { return below_->levelOf(id); }
  void checkInvariants() const override;

 private:
  struct Located {
    bool stored = false;  // whether the entry belongs to a stored box
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
