// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#include "partitions/kd_nodes.h"

namespace hgrid {
namespace book {
namespace {

// Centers are only compared with each other, so twice the center serves as well and needs no division.

/// Twice the center of a box [m].
Eigen::Vector3d twiceCenter(const Aabb& box) { return box.min.cast<double>() + box.max.cast<double>(); }
/// Twice the center of a box on one axis [m].
double twiceCenter(const Aabb& box, int axis) { return double(box.min[axis]) + double(box.max[axis]); }

/// The axis on which the centers of the boxes are spread most.
int widestAxis(const std::vector<Aabb>& boxes, const ProxyId* begin, const ProxyId* end) {
  Eigen::Vector3d low = twiceCenter(boxes[*begin]), high = low;
  for (const ProxyId* id = begin; id != end; ++id) {
    low = low.cwiseMin(twiceCenter(boxes[*id])).eval();
    high = high.cwiseMax(twiceCenter(boxes[*id])).eval();
  }
  int axis;
  (high - low).maxCoeff(&axis);
  return axis;
}

}  // namespace

void KdNodes::build(const std::vector<Aabb>& boxes, const std::vector<ProxyId>& ids) {
  nodes_.clear();
  ids_ = ids;
  nodes_.reserve(ids.size() / 2 + 1);
  if (!ids_.empty()) divide(boxes, 0, static_cast<std::uint32_t>(ids_.size()));
}

/// Appends the node of a range of `ids_` and the nodes below it. Each step halves the range, so the depth is at most
/// log2 of the number of boxes.
void KdNodes::divide(const std::vector<Aabb>& boxes, std::uint32_t begin, std::uint32_t end) {
  const auto index = static_cast<std::uint32_t>(nodes_.size());
  nodes_.push_back({0.0f, 0.0f, kIsLeaf, begin, end, 0});  // the last line replaces it if the node is no leaf
  if (end - begin <= kLeaf) return;
  const int axis = widestAxis(boxes, &ids_[begin], ids_.data() + end);
  const std::uint32_t middle = begin + (end - begin) / 2;
  std::nth_element(ids_.begin() + begin, ids_.begin() + middle, ids_.begin() + end, [&](ProxyId a, ProxyId b) {
    const double center_a = twiceCenter(boxes[a], axis), center_b = twiceCenter(boxes[b], axis);
    return center_a != center_b ? center_a < center_b : a < b;
  });
  float low_end = boxes[ids_[begin]].max[axis], high_begin = boxes[ids_[middle]].min[axis];
  for (std::uint32_t i = begin; i < middle; ++i) low_end = std::max(low_end, boxes[ids_[i]].max[axis]);
  for (std::uint32_t i = middle; i < end; ++i) high_begin = std::min(high_begin, boxes[ids_[i]].min[axis]);
  divide(boxes, begin, middle);
  const auto high = static_cast<std::uint32_t>(nodes_.size());
  divide(boxes, middle, end);
  nodes_[index] = {low_end, high_begin, axis, begin, end, high};
}

}  // namespace book
}  // namespace hgrid
