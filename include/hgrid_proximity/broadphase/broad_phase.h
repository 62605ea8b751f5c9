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

  virtual std::size_t size() const = 0;

  /// Every overlapping pair once, in no promised order.
  virtual void overlappingPairs(std::vector<ProxyPair>& pairs) const = 0;
  /// Boxes that overlap `box`, ids ascending.
  virtual void overlapping(const Aabb& box, std::vector<ProxyId>& found) const = 0;
  /// Boxes that touch the ball, ids ascending; superset within rounding as touches() says.
  virtual void overlapping(const Sphere& sphere, std::vector<ProxyId>& found) const = 0;
  /// Boxes that the segment meets, by `along`, then id; superset within rounding as meet() says.
  virtual void along(const Segment& segment, std::vector<SegmentHit>& found) const = 0;

  /// @throws std::logic_error naming the first promise of the structure that does not hold.
  virtual void checkInvariants() const = 0;
};

}  // namespace hgrid
