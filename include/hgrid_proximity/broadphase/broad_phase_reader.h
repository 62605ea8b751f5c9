// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

#include <cstdint>
#include <vector>

#include "hgrid_proximity/geometry/aabb.h"
#include "hgrid_proximity/geometry/segment.h"
#include "hgrid_proximity/geometry/sphere.h"

namespace hgrid {

/// Number of one box in a broad phase. The caller chooses it. Ids index arrays, so they should be small.
using ProxyId = std::uint32_t;

/// Two boxes that overlap, the smaller id first.
struct ProxyPair {
  ProxyId first = 0;
  ProxyId second = 0;
  bool operator==(const ProxyPair& other) const { return first == other.first && second == other.second; }
  bool operator<(const ProxyPair& other) const {
    return first != other.first ? first < other.first : second < other.second;
  }
};

/// A box that a segment meets.
struct SegmentHit {
  ProxyId id = 0;
  double along = 0.0;  ///< [m] from the start of the segment to the first touch
};

/// A box near a point.
struct NearHit {
  ProxyId id = 0;
  double distance = 0.0;  ///< [m] 0 if the point is inside
};

/// Answers to many questions at once, as a structure of arrays. The answers to question q are found[begin[q]] ..
/// found[begin[q] + count[q] - 1], in the order that a single question has.
template <class Found>
struct BatchOf {
  std::vector<std::uint32_t> begin, count;
  std::vector<Found> found;
};
using IdBatch = BatchOf<ProxyId>;
using SegmentBatch = BatchOf<SegmentHit>;

/// One level of a broad phase that sorts boxes by size.
struct BroadPhaseLevel {
  double edge = 0.0;      ///< [m] longest side of its boxes; infinite for the last level
  std::size_t boxes = 0;  ///< stored boxes on the level
};

/// Answers "which boxes overlap?".
///
/// Boxes that only touch overlap. A result replaces what the caller's buffer held. Calls may run concurrently with each
/// other, but not with a change of the stored boxes. The answers do not depend on the order in which the boxes came.
class BroadPhaseReader {
 public:
  virtual ~BroadPhaseReader() = default;

  /// Number of stored boxes.
  virtual std::size_t size() const = 0;

  /// Every overlapping pair once, in no promised order. Pairs of two fixed boxes are left out, and pairs that the
  /// overlap filter does not keep (see BroadPhase).
  virtual void overlappingPairs(std::vector<ProxyPair>& pairs) const = 0;
  /// The same within the pair bound (see PairBound). @returns whether these are all pairs
  virtual bool boundedPairs(std::vector<ProxyPair>& pairs) const = 0;

  /// Boxes that overlap `box`, ids ascending.
  virtual void overlapping(const Aabb& box, std::vector<ProxyId>& found) const = 0;
  /// Boxes that touch the sphere, ids ascending. May contain boxes that miss it by a rounding error, as touches() does.
  virtual void overlapping(const Sphere& sphere, std::vector<ProxyId>& found) const = 0;
  /// Boxes that the segment meets, sorted by `along`, then by id. May contain boxes that the segment misses by a
  /// rounding error, as meet() does.
  virtual void along(const Segment& segment, std::vector<SegmentHit>& found) const = 0;
  /// The `count` boxes nearest to a point, none farther than `limit` [m], sorted by distance, then by id.
  virtual void nearest(const Eigen::Vector3d& point, std::size_t count, double limit,
                       std::vector<NearHit>& found) const = 0;

  /// Answers many questions at once. By default, asks them one after another.
  virtual void overlapping(const std::vector<Aabb>& boxes, IdBatch& found) const;
  virtual void overlapping(const std::vector<Sphere>& spheres, IdBatch& found) const;
  virtual void along(const std::vector<Segment>& segments, SegmentBatch& found) const;

  /// The levels, from small boxes to large ones. Empty if boxes are not sorted by size. Looks at every box.
  virtual std::vector<BroadPhaseLevel> levels() const { return {}; }
  /// Index of a stored box's level; -1 if the box is not stored or there are no levels.
  virtual int levelOf(ProxyId) const { return -1; }

  /// @throws std::logic_error naming the first promise of the data structure that does not hold.
  virtual void checkInvariants() const = 0;
};

}  // namespace hgrid
