// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "broadphase/book/query_shape.h"
#include "hgrid_proximity/broadphase/broad_phase_reader.h"

namespace hgrid {
namespace book {

/// The nodes of a k-d tree over boxes (Ericson, Real-Time Collision Detection, 2005, section 7.3.7).
///
/// A node divides its boxes by their centers at the median along one axis, the one on which the centers are spread
/// most.
///
/// Differs from the book: a node has two planes instead of one, the largest coordinate of the low side's boxes and the
/// smallest coordinate of the high side's boxes. So each box is in one leaf only, and a box on the dividing line
/// neither sticks to the node nor is split. Comparisons include touching boxes, which the printed sphere visit drops.
class KdNodes {
 public:
  /// Builds the tree over these boxes; `boxes` is indexed by id.
  void build(const std::vector<Aabb>& boxes, const std::vector<ProxyId>& ids);
  const std::vector<ProxyId>& ids() const { return ids_; }
  std::size_t bytes() const { return nodes_.capacity() * sizeof(Node) + ids_.capacity() * sizeof(ProxyId); }

  /// Calls visit(id) for all boxes in the leaves that the shape touches.
  template <class Visit>
  void visit(const QueryShape& shape, Visit&& visit) const;
  /// Visits the leaves along a segment from near to far. visit(id) returns the fraction of the segment up to which the
  /// search goes on, so a search for the first hit ends early.
  template <class Visit>
  void visitAlong(const QueryShape& shape, Visit&& visit) const;
  /// Visits the leaves near a point, the nearer side first. visit(id) returns the radius [m] of the sphere that is
  /// still of interest, so the sphere shrinks with each box that is found.
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
    float low_end, high_begin;  // the low side ends here, the high side begins here
    int axis;
    std::uint32_t begin, end;  // range in ids_ of the boxes below the node
    std::uint32_t high;        // index of the high child; the low child follows its parent
  };

  void divide(const std::vector<Aabb>& boxes, std::uint32_t begin, std::uint32_t end);
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

/// `nearest` is the point of the node's region that is nearest to the center. On the way down, only its coordinate on
/// the dividing axis moves; it is restored on the way up.
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
    if ((nearest - center).squaredNorm() * (1.0 - 4e-12) <= radius * radius)
      sphereFrom(low ? index + 1 : node.high, center, nearest, radius, visit);
  }
  nearest[node.axis] = before;
}

/// `enter` and `leave` are the fractions of the segment between which it is inside the node's region. Fractions of the
/// whole segment replace the moved origin of the book, so rounding does not add up.
template <class Visit>
void KdNodes::segmentFrom(std::uint32_t index, const QueryShape& shape, double enter, double leave, double& until,
                          Visit&& visit) const {
  const Node& node = nodes_[index];
  if (node.axis == kIsLeaf) {
    for (std::uint32_t i = node.begin; i < node.end; ++i) until = visit(ids_[i]);
    return;
  }
  const double from = shape.segment().from[node.axis], step = shape.segment().to[node.axis] - from;
  const double low_plane =
      double(node.low_end) + shape.radiusWithSlack() - from;  // the segment is in the low side up to here
  const double high_plane =
      double(node.high_begin) - shape.radiusWithSlack() - from;  // and in the high side from here on
  const bool parallel = std::abs(step) <= 1e-100;
  for (const bool low : {!(step < 0.0), step < 0.0}) {  // the sign of the step decides which side is nearer
    const double plane = low ? low_plane : high_plane;
    double first = enter, last = leave;
    if (parallel) {
      if (low ? plane < 0.0 : plane > 0.0) continue;
    } else if (low == (step > 0.0)) {
      last = std::min(leave, plane / step);
    } else {
      first = std::max(enter, plane / step);
    }
    if (first <= last + 1e-12 && first <= until + 1e-12)
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
