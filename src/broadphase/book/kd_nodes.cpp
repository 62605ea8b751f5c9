// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#include "broadphase/book/kd_nodes.h"

namespace hgrid {
namespace book {
namespace {

/// Twice the center of a box on an axis [m].
double twiceCenter(const Aabb& box, int axis) { return double(box.min[axis]) + double(box.max[axis]); }

/// The axis on which the centers of boxes are spread most.
int widestAxis(const std::vector<Aabb>& boxes, const ProxyId* begin, const ProxyId* end) {
  const auto centerOf = [&](ProxyId id) {  // twice the center, which serves as well
    return Eigen::Vector3d(boxes[id].min.cast<double>() + boxes[id].max.cast<double>());
  };
  Eigen::Vector3d low = centerOf(*begin), high = low;
  for (const ProxyId* id = begin; id != end; ++id) {
    low = low.cwiseMin(centerOf(*id)).eval();
    high = high.cwiseMax(centerOf(*id)).eval();
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

/// Appends the node of a range of boxes and the nodes below it. The depth is at most log2 of the number of boxes.
void KdNodes::divide(const std::vector<Aabb>& boxes, std::uint32_t begin, std::uint32_t end) {
  const auto index = static_cast<std::uint32_t>(nodes_.size());
  nodes_.push_back({0.0f, 0.0f, kIsLeaf, begin, end, 0});
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
