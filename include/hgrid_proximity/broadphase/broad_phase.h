// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

#include <cstdint>
#include <vector>

#include "hgrid_proximity/geometry/aabb.h"
#include "hgrid_proximity/geometry/segment.h"
#include "hgrid_proximity/geometry/sphere.h"

namespace hgrid {

/// Number of one box in a broad phase, chosen by the caller; small numbers, since they index arrays.
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

/// A box that a segment meets, and how far along [m].
struct SegmentHit {
  ProxyId id = 0;
  double along = 0.0;
};

/// A box near a point, and how far away [m]; 0 if the point is inside.
struct NearHit {
  ProxyId id = 0;
  double distance = 0.0;
};

/// Answers to many questions at once, structure of arrays: those to question q are found[begin[q]] ..
/// found[begin[q] + count[q] - 1], ordered as a single question would have them.
template <class Found>
struct BatchOf {
  std::vector<std::uint32_t> begin, count;
  std::vector<Found> found;
};
using IdBatch = BatchOf<ProxyId>;
using SegmentBatch = BatchOf<SegmentHit>;

/// Answers "which boxes overlap?". One writer at a time; const calls may run side by side and give the
/// same results. Boxes that only touch overlap. Results replace what the caller's buffer held.
class BroadPhase {
 public:
  virtual ~BroadPhase() = default;

  /// @throws std::invalid_argument if `id` is stored already or the box is not valid.
  virtual void insert(ProxyId id, const Aabb& box) = 0;
  /// Moves a box. @throws std::invalid_argument if `id` is not stored or the box is not valid.
  virtual void update(ProxyId id, const Aabb& box) = 0;
  /// @throws std::invalid_argument if `id` is not stored.
  virtual void remove(ProxyId id) = 0;
  virtual void clear() = 0;

  /// Bulk update: afterwards exactly these boxes are stored, boxes[i] under ids[i]; ids ascending.
  /// @throws std::invalid_argument if the arrays do not match, ids do not ascend or a box is not valid;
  /// then nothing has changed.
  virtual void update(const std::vector<ProxyId>& ids, const std::vector<Aabb>& boxes) = 0;
  /// Bulk move: ids[i] is now boxes[i], everything else rests; ids ascending. Costs what moves, not what is stored.
  /// @throws std::invalid_argument as above, or if an id is not stored; then nothing has changed.
  virtual void move(const std::vector<ProxyId>& ids, const std::vector<Aabb>& boxes) = 0;

  virtual std::size_t size() const = 0;

  /// Every overlapping pair once, in no promised order.
  virtual void overlappingPairs(std::vector<ProxyPair>& pairs) const = 0;
  /// Boxes that overlap `box`, ids ascending.
  virtual void overlapping(const Aabb& box, std::vector<ProxyId>& found) const = 0;
  /// Boxes that touch the ball, ids ascending; superset within rounding as touches() says.
  virtual void overlapping(const Sphere& sphere, std::vector<ProxyId>& found) const = 0;
  /// Boxes that the segment meets, by `along`, then id; superset within rounding as meet() says.
  virtual void along(const Segment& segment, std::vector<SegmentHit>& found) const = 0;
  /// The `count` boxes nearest to a point, none farther than `limit` [m], by distance, then id.
  virtual void nearest(const Eigen::Vector3d& point, std::size_t count, double limit,
                       std::vector<NearHit>& found) const = 0;

  /// Many questions at once, answered in an order of their places, which spares the memory.
  virtual void overlapping(const std::vector<Aabb>& boxes, IdBatch& found) const = 0;
  virtual void overlapping(const std::vector<Sphere>& spheres, IdBatch& found) const = 0;
  virtual void along(const std::vector<Segment>& segments, SegmentBatch& found) const = 0;

  /// @throws std::logic_error naming the first promise of the structure that does not hold.
  virtual void checkInvariants() const = 0;
};

}  // namespace hgrid
