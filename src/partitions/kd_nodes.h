// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "hgrid_proximity/broadphase/broad_phase_reader.h"
#include "partitions/query_shape.h"

namespace hgrid {
namespace book {

/// The nodes of a k-d tree over boxes (Ericson, Real-Time Collision Detection, 2005, section 7.3.7).
///
/// A node divides its boxes at the median of their centers, along the axis on which the centers are spread most. Boxes
/// are only in leaves.
///
/// Differs from the book:
/// - A node has two planes instead of one: where the boxes of the low side end, and where those of the high side begin.
///   So each box is in one leaf, also if it crosses the median. The two sides may overlap, and there may be a gap
///   between them.
/// - The sphere visit includes touching boxes, which the strict comparison of the listing drops.
/// - The segment visit (section 7.4.1) does not move the origin of the segment. It passes down two fractions of the
///   whole segment, so rounding does not add up. A thick segment widens the two sides by its radius. The sign of the
///   direction decides which side is nearer, so an origin on a plane is no special case.
class KdNodes {
 public:
  /// Builds the tree over these boxes; `boxes` is indexed by id.
  void build(const std::vector<Aabb>& boxes, const std::vector<ProxyId>& ids);
  const std::vector<ProxyId>& ids() const { return ids_; }
  std::size_t bytes() const { return nodes_.capacity() * sizeof(Node) + ids_.capacity() * sizeof(ProxyId); }

  /// Calls visit(id) for the boxes in all leaves that the shape touches. Some of these boxes may miss the shape.
  template <class Visit>
  void visit(const QueryShape& shape, Visit&& visit) const;
  /// Visits the leaves along a segment, the nearer side of each node first. visit(id) returns the fraction of the
  /// segment that is still of interest: the search leaves out what begins behind it. So a search for the first hit ends
  /// early.
  template <class Visit>
  void visitAlong(const QueryShape& shape, Visit&& visit) const;
  /// Visits the leaves near a point, the nearer side of each node first. visit(id) returns the radius [m] of the sphere
  /// that is still of interest. So a search for the nearest boxes can shrink the sphere.
  template <class Visit>
  void visitNear(const Eigen::Vector3d& point, double radius, Visit&& visit) const;
  /// Calls visit(region) for the region of each leaf within `world`.
  template <class Visit>
  void visitRegions(const Aabb& world, Visit&& visit) const {
    if (!nodes_.empty()) regionsFrom(0, world, visit);
  }

 private:
  static constexpr std::size_t kLeaf = 8;  // largest number of boxes in a leaf
  static constexpr int kIsLeaf = 3;        // Node::axis of a leaf
  struct Node {
    float low_end, high_begin;  // [m] largest end of a box of the low side, smallest begin of a box of the high side
    int axis;                   // of the planes; kIsLeaf for a leaf
    std::uint32_t begin, end;   // range in ids_ of the boxes below the node
    std::uint32_t high;         // index of the high child; the low child is the next node after its parent
  };

  void divide(const std::vector<Aabb>& boxes, std::uint32_t begin, std::uint32_t end);
  // Each of the functions ...From() visits the node with the given index and the nodes below it.
  template <class Visit>
  void boxFrom(std::uint32_t index, const Aabb& query, Visit&& visit) const;
  template <class Visit>
  void sphereFrom(std::uint32_t index, const Eigen::Vector3d& center, Eigen::Vector3d& nearest, double& radius,
                  Visit&& visit) const;
  template <class Visit>
  void segmentFrom(std::uint32_t index, const QueryShape& shape, double enter, double leave, double& until,
                   Visit&& visit) const;
  template <class Visit>
  void regionsFrom(std::uint32_t index, const Aabb& region, Visit&& visit) const;

  std::vector<Node> nodes_;
  std::vector<ProxyId> ids_;
};

template <class Visit>
void KdNodes::visit(const QueryShape& shape, Visit&& visit) const {
  if (nodes_.empty()) return;
  if (shape.kind() == QueryShape::Kind::box) return boxFrom(0, shape.bounds(), visit);
  if (shape.kind() == QueryShape::Kind::segment) {
    return visitAlong(shape, [&](ProxyId id) {
      visit(id);
      return 1.0;
    });
  }
  visitNear(shape.sphere().center, shape.radiusWithSlack(), [&](ProxyId id) {
    visit(id);
    return shape.radiusWithSlack();
  });
}

template <class Visit>
void KdNodes::visitAlong(const QueryShape& shape, Visit&& visit) const {
  double until = 1.0;
  if (!nodes_.empty()) segmentFrom(0, shape, 0.0, 1.0, until, visit);
}

template <class Visit>
void KdNodes::visitNear(const Eigen::Vector3d& point, double radius, Visit&& visit) const {
  Eigen::Vector3d nearest = point;
  if (!nodes_.empty()) sphereFrom(0, point, nearest, radius, visit);
}

template <class Visit>
void KdNodes::boxFrom(std::uint32_t index, const Aabb& query, Visit&& visit) const {
  const Node& node = nodes_[index];
  if (node.axis == kIsLeaf) {
    for (std::uint32_t i = node.begin; i < node.end; ++i) visit(ids_[i]);
    return;
  }
  if (query.min[node.axis] <= node.low_end) boxFrom(index + 1, query, visit);
  if (query.max[node.axis] >= node.high_begin) boxFrom(node.high, query, visit);
}

/// `nearest` is the point of the node's region that is nearest to the center of the sphere. Before a child is visited,
/// only the coordinate on the dividing axis changes; afterwards, the old coordinate is restored. So the bounds of the
/// nodes are never computed.
template <class Visit>
void KdNodes::sphereFrom(std::uint32_t index, const Eigen::Vector3d& center, Eigen::Vector3d& nearest, double& radius,
                         Visit&& visit) const {
  const Node& node = nodes_[index];
  if (node.axis == kIsLeaf) {
    for (std::uint32_t i = node.begin; i < node.end; ++i) radius = visit(ids_[i]);
    return;
  }
  const double before = nearest[node.axis];
  const double in_low = std::min(before, double(node.low_end)), in_high = std::max(before, double(node.high_begin));
  const bool low_first = std::abs(in_low - center[node.axis]) <= std::abs(in_high - center[node.axis]);
  for (const bool low : {low_first, !low_first}) {
    nearest[node.axis] = low ? in_low : in_high;
    // `radius` may have shrunk since the first side. The factor allows for rounding. Squares, because these are also
    // comparable if both overflow.
    constexpr double kShrunk = 1.0 - 4e-12;
    if ((nearest - center).squaredNorm() * kShrunk <= radius * radius)
      sphereFrom(low ? index + 1 : node.high, center, nearest, radius, visit);
  }
  nearest[node.axis] = before;
}

/// `enter` and `leave` are the fractions of the segment between which it is in the node's region. `until` is the
/// fraction up to which the search is still of interest.
template <class Visit>
void KdNodes::segmentFrom(std::uint32_t index, const QueryShape& shape, double enter, double leave, double& until,
                          Visit&& visit) const {
  const Node& node = nodes_[index];
  if (node.axis == kIsLeaf) {
    for (std::uint32_t i = node.begin; i < node.end; ++i) until = visit(ids_[i]);
    return;
  }
  const double from = shape.segment().from[node.axis], step = shape.segment().to[node.axis] - from;
  // The planes [m] relative to the start of the segment, moved by its radius. The segment is in the low side where it
  // is below `low_plane`, and in the high side where it is above `high_plane`.
  const double low_plane = double(node.low_end) + shape.radiusWithSlack() - from;
  const double high_plane = double(node.high_begin) - shape.radiusWithSlack() - from;
  const bool parallel = std::abs(step) <= kLeastStep;
  for (const bool low : {!(step < 0.0), step < 0.0}) {  // the nearer side first
    const double plane = low ? low_plane : high_plane;
    double first = enter, last = leave;
    if (parallel) {
      if (low ? plane < 0.0 : plane > 0.0) continue;
    } else if (low == (step > 0.0)) {
      last = std::min(leave, plane / step);
    } else {
      first = std::max(enter, plane / step);
    }
    if (first <= last + kFractionRounding && first <= until + kFractionRounding)
      segmentFrom(low ? index + 1 : node.high, shape, first, last, until, visit);
  }
}

template <class Visit>
void KdNodes::regionsFrom(std::uint32_t index, const Aabb& region, Visit&& visit) const {
  const Node& node = nodes_[index];
  if (node.axis == kIsLeaf) return visit(region);
  Aabb low = region, high = region;
  low.max[node.axis] = node.low_end;
  high.min[node.axis] = node.high_begin;
  regionsFrom(index + 1, low, visit);
  regionsFrom(node.high, high, visit);
}

}  // namespace book
}  // namespace hgrid
