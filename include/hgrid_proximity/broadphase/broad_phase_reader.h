// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

#include <cstdint>
#include <vector>

#include "hgrid_proximity/geometry/aabb.h"
#include "hgrid_proximity/geometry/segment.h"
#include "hgrid_proximity/geometry/sphere.h"

namespace hgrid {

/// Identifies one box in a broad phase. The caller chooses the ids. They index arrays, so they should be small numbers.
using ProxyId = std::uint32_t;

/// The ids of two boxes that overlap, the smaller id first.
struct ProxyPair {
  ProxyId first = 0;   ///< the smaller id
  ProxyId second = 0;  ///< the larger id

  /// Whether both pairs have the same ids.
  bool operator==(const ProxyPair& other) const { return first == other.first && second == other.second; }
  /// Orders pairs by `first`, then by `second`.
  bool operator<(const ProxyPair& other) const {
    return first != other.first ? first < other.first : second < other.second;
  }
};

/// A box that a segment touches.
struct SegmentHit {
  ProxyId id = 0;      ///< id of the box
  double along = 0.0;  ///< [m] distance from the start of the segment to the point where it first touches the box
};

/// A box near a point.
struct NearHit {
  ProxyId id = 0;         ///< id of the box
  double distance = 0.0;  ///< [m] distance of the box from the point; 0 if the point is inside the box
};

/// One level of a broad phase that sorts boxes by size.
struct BroadPhaseLevel {
  double edge = 0.0;      ///< [m] longest side that a box of the level can have; infinite for the last level
  std::size_t boxes = 0;  ///< number of stored boxes on the level
};

/// Finds the boxes that overlap each other or that overlap the shape of a query.
///
/// Boxes that only touch count as overlapping. A result replaces the old content of the caller's buffer. Several
/// threads may call these functions at the same time, but not while another thread changes the stored boxes. The
/// answers do not depend on the order in which the boxes were inserted.
class BroadPhaseReader {
 public:
  virtual ~BroadPhaseReader() = default;

  /// Number of stored boxes.
  virtual std::size_t size() const = 0;

  /// Finds every overlapping pair once. The order of the pairs is not specified. The search leaves out pairs of two
  /// fixed boxes and pairs that the overlap filter does not keep (see BroadPhase).
  virtual void overlappingPairs(std::vector<ProxyPair>& pairs) const = 0;
  /// Finds overlapping pairs within the pair bound (see PairBound). @returns whether these are all pairs
  virtual bool boundedPairs(std::vector<ProxyPair>& pairs) const = 0;

  /// Finds the boxes that overlap `box`, in ascending order of their ids.
  virtual void overlapping(const Aabb& box, std::vector<ProxyId>& found) const = 0;
  /// Finds the boxes that touch the sphere, in ascending order of their ids. Like touches(), it may include boxes that
  /// miss the sphere by a rounding error.
  virtual void overlapping(const Sphere& sphere, std::vector<ProxyId>& found) const = 0;
  /// Finds the boxes that the segment touches, sorted by `along`, then by id. Like meet(), it may include boxes that
  /// the segment misses by a rounding error.
  virtual void along(const Segment& segment, std::vector<SegmentHit>& found) const = 0;
  /// Finds the `count` boxes nearest to a point that are at most `limit` [m] away, sorted by distance, then by id.
  virtual void nearest(const Eigen::Vector3d& point, std::size_t count, double limit,
                       std::vector<NearHit>& found) const = 0;

  /// Returns the levels, from small boxes to large ones; nothing if the broad phase does not sort boxes by size. Takes
  /// time proportional to the number of stored boxes.
  virtual std::vector<BroadPhaseLevel> levels() const { return {}; }
  /// Returns the index of the level that a box is stored on; -1 if the box is not stored or there are no levels.
  virtual int levelOf(ProxyId) const { return -1; }

  /// Checks the invariants of the data structure. @throws std::logic_error that names the first violated invariant
  virtual void checkInvariants() const = 0;
};

}  // namespace hgrid
