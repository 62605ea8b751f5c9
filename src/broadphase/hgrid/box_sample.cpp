// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#include "broadphase/hgrid/box_sample.h"

#include <algorithm>

namespace hgrid {

BoxSample::BoxSample(const std::vector<Aabb>& boxes, const ProxyId* ids, std::size_t count) {
  size_ = std::min(count, kMost);
  for (std::size_t i = 0; i < size_; ++i) {
    const Aabb& box = boxes[ids[i * count / size_]];
    for (std::size_t axis = 0; axis < 3; ++axis) sorted_[axis][i] = box.min[static_cast<Eigen::Index>(axis)];
  }
  for (auto& values : sorted_) std::sort(values.begin(), values.begin() + static_cast<std::ptrdiff_t>(size_));
  boxes_per_sampled_box_ = static_cast<double>(count) / static_cast<double>(size_);
}

double BoxSample::followers(std::size_t axis, double length) const {
  const auto& values = sorted_[axis];
  std::size_t end = 0, sum = 0;
  for (std::size_t i = 0; i < size_; ++i) {
    while (end < size_ && values[end] <= static_cast<double>(values[i]) + length) ++end;
    sum += end - i - 1;
  }
  return boxes_per_sampled_box_ * static_cast<double>(sum) / static_cast<double>(size_);
}

}  // namespace hgrid
