// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

#include <map>
#include <set>

#include "hgrid_proximity/broadphase/broad_phase.h"

namespace hgrid {
namespace test {

/// A broad phase without a search structure: each query checks all boxes, or all pairs of boxes.
class BruteForce final : public BroadPhase {
 public:
  /// Returns the stored boxes by id.
  const std::map<ProxyId, Aabb>& boxes() const { return boxes_; }

  void insert(ProxyId id, const Aabb& box) override;
  void update(ProxyId id, const Aabb& box) override;
  void remove(ProxyId id) override;
  void clear() override { boxes_.clear(); }
  void update(const std::vector<ProxyId>& ids, const std::vector<Aabb>& boxes) override;
  void move(const std::vector<ProxyId>& ids, const std::vector<Aabb>& boxes) override;
  void setFixed(const std::vector<ProxyId>& ids) override;
  void setOverlapFilter(const OverlapFilter& filter) override { filter_ = filter; }
  void setPairBound(const PairBound& bound) override { bound_ = bound; }

  std::size_t size() const override { return boxes_.size(); }
  void overlappingPairs(std::vector<ProxyPair>& pairs) const override { collect(PairBound{}, pairs); }
  bool boundedPairs(std::vector<ProxyPair>& pairs) const override { return collect(bound_, pairs); }
  using BroadPhaseReader::along;
  using BroadPhaseReader::overlapping;
  void overlapping(const Aabb& box, std::vector<ProxyId>& found) const override;
  void overlapping(const Sphere& sphere, std::vector<ProxyId>& found) const override;
  void along(const Segment& segment, std::vector<SegmentHit>& found) const override;
  void nearest(const Eigen::Vector3d& point, std::size_t count, double limit,
               std::vector<NearHit>& found) const override;
  void checkInvariants() const override;

 private:
  bool collect(const PairBound& bound, std::vector<ProxyPair>& pairs) const;
  bool isKept(ProxyPair pair) const { return filter_(&pair, &pair + 1) != &pair; }

  std::map<ProxyId, Aabb> boxes_;
  std::set<ProxyId> fixed_;
  OverlapFilter filter_;
  PairBound bound_;
};

}  // namespace test
}  // namespace hgrid
