// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#include "broadphase/hgrid/box_sample.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <utility>

#include "broadphase/kernels/kernels.h"
#include "geometry/infinity.h"
#include "geometry/rounding.h"

namespace hgrid {
namespace {

/// Inserts a value into a sorted array and drops the last value of the array.
template <std::size_t kCount, class Before>
void insertSorted(std::array<float, kCount>& sorted, float value, Before before) {
  for (float& other : sorted) {
    if (before(value, other)) std::swap(value, other);
  }
}

}  // namespace

BoxSample::BoxSample(const std::vector<Aabb>& boxes, const ProxyId* ids, std::size_t count) {
  size_ = std::min(count, kMost);
  for (std::size_t i = 0; i < size_; ++i) {
    const std::size_t begin = i * count / size_, end = (i + 1) * count / size_;
    const Aabb& box = boxes[ids[begin + scatteredBelow(end - begin, i)]];
    corners_[i] = {box.min[0], box.min[1], box.min[2]};
  }
  boxes_per_sampled_box_ = static_cast<double>(count) / static_cast<double>(size_);
  for (std::size_t axis = 0; axis < 3; ++axis) {
    // The lowest and the highest values, the outermost first. Few values are among them, so few are inserted.
    std::array<float, kMost / 100 + 1> lowest, highest;
    lowest.fill(kFloatInfinity);
    highest.fill(-kFloatInfinity);
    for (std::size_t i = 0; i < size_; ++i) {
      const float value = corners_[i][axis];
      if (value < lowest.back()) insertSorted(lowest, value, std::less<>());
      if (value > highest.back()) insertSorted(highest, value, std::greater<>());
    }
    low_[axis] = lowest[size_ / 100];
    high_[axis] = highest[size_ / 100];
  }
}

std::array<float, BoxSample::kMost> BoxSample::onAxis(std::size_t axis) const {
  std::array<float, kMost> values;
  for (std::size_t i = 0; i < size_; ++i) values[i] = corners_[i][axis];
  return values;
}

double BoxSample::followers(std::size_t axis, double length) const {
  std::array<float, kMost> values = onAxis(axis);
  std::sort(values.begin(), values.begin() + static_cast<std::ptrdiff_t>(size_));
  std::size_t end = 0, sum = 0;
  for (std::size_t i = 0; i < size_; ++i) {
    while (end < size_ && values[end] <= static_cast<double>(values[i]) + length) ++end;
    sum += end - i - 1;
  }
  return boxes_per_sampled_box_ * static_cast<double>(sum) / static_cast<double>(size_);
}

double BoxSample::leastFollowers(std::size_t axis, double length) const {
  constexpr std::size_t kFew = 48;
  if (size_ < kFew) return 0.0;
  std::array<float, kFew> values;
  for (std::size_t i = 0; i < kFew; ++i) values[i] = corners_[i * size_ / kFew][axis];
  const auto most = static_cast<float>(std::min(length, static_cast<double>(kernels::kMostFloat)));
  int near = 0;  // counts two values that are near each other twice, and each value with itself
  for (const float a : values) {
    for (const float b : values) near += std::abs(a - b) <= most;
  }
  const double pairs = 0.5 * (near - static_cast<int>(kFew));
  const double least = std::max(0.0, pairs - 3.0 * std::sqrt(pairs));  // three standard deviations below
  return boxes_per_sampled_box_ * static_cast<double>(size_) * least / static_cast<double>(kFew * kFew);
}

bool BoxSample::isThin(std::size_t axis, const std::array<double, 3>& sides) const {
  constexpr std::size_t kGroup = 16;               // successive sampled boxes whose extent is measured
  constexpr double kSmall = 0.1, kFewBoxes = 4.0;  // fraction of the whole cross section; or cross sections of a box
  const std::size_t y = (axis + 1) % 3, z = (axis + 2) % 3;
  auto corners = corners_;
  const auto end = corners.begin() + static_cast<std::ptrdiff_t>(size_);
  std::sort(corners.begin(), end, [axis](const auto& a, const auto& b) { return a[axis] < b[axis]; });
  const auto extent = [&](auto from, auto to, std::size_t i) {
    const auto [least, most] = std::minmax_element(from, to, [i](const auto& a, const auto& b) { return a[i] < b[i]; });
    return static_cast<double>((*most)[i]) - (*least)[i];
  };
  const auto side = [&sides](std::size_t i) { return std::max(sides[i], kLeastLength); };
  const auto area = [&](auto from, auto to) {
    return (extent(from, to, y) + side(y)) * (extent(from, to, z) + side(z));
  };
  double sum = 0.0, groups = 0.0;
  for (auto from = corners.begin(); from != end; groups += 1.0) {
    const auto to = from + std::min<std::ptrdiff_t>(kGroup, end - from);
    sum += area(from, to);
    from = to;
  }
  return sum <= groups * std::max(kSmall * area(corners.begin(), end), kFewBoxes * side(y) * side(z));
}

}  // namespace hgrid
