// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#include "hgrid_proximity/geometry/aabb.h"

#include <array>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <limits>

namespace hgrid {
namespace {

/// An exact sum of doubles, stored as a list of parts that do not overlap, with the largest part last (Shewchuk 1997,
/// GROW-EXPANSION). The sum has the sign of its largest part.
class ExactSum {
 public:
  void add(double value) {
    int kept = 0;
    for (int i = 0; i < size_; ++i) {
      double large = value, small = parts_[static_cast<std::size_t>(i)];
      if (std::abs(large) < std::abs(small)) std::swap(large, small);
      const double sum = large + small;
      const double error = small - (sum - large);
      if (error != 0.0) parts_[static_cast<std::size_t>(kept++)] = error;
      value = sum;
    }
    parts_[static_cast<std::size_t>(kept)] = value;
    size_ = kept + 1;
  }
  void addProduct(double a, double b) {
    const double product = a * b;
    add(product);
    add(std::fma(a, b, -product));
  }
  double sign() const { return parts_[static_cast<std::size_t>(size_ - 1)]; }

 private:
  std::array<double, 40> parts_{};
  int size_ = 0;
};

/// The distance of two intervals along one axis is high - low. Both numbers are 0 if the intervals overlap.
struct AxisGap {
  double high = 0.0, low = 0.0;
};

AxisGap axisGap(const Aabb& a, const Aabb& b, int axis) {
  if (a.min[axis] > b.max[axis]) return {a.min[axis], b.max[axis]};
  if (b.min[axis] > a.max[axis]) return {b.min[axis], a.max[axis]};
  return {};
}

/// Returns the sign of distance² - margin², without rounding.
///
/// The distance along an axis is exactly h + l, where h is the rounded difference and l its rounding error. So the
/// square of the distance is h² + 2hl + l².
double exactComparison(const Aabb& a, const Aabb& b, double margin) {
  ExactSum sum;
  for (int axis = 0; axis < 3; ++axis) {
    const AxisGap gap = axisGap(a, b, axis);
    const double h = gap.high - gap.low;
    const double part = h - gap.high;  // computes the rounding error l by TWO-DIFF (Shewchuk 1997)
    const double l = (gap.high - (h - part)) - (gap.low + part);
    sum.addProduct(h, h);
    sum.addProduct(2.0 * h, l);
    sum.addProduct(l, l);
  }
  sum.addProduct(-margin, margin);
  return sum.sign();
}

double squaredDistance(const Aabb& a, const Aabb& b) {
  double sum = 0.0;
  for (int axis = 0; axis < 3; ++axis) {
    const AxisGap gap = axisGap(a, b, axis);
    sum += (gap.high - gap.low) * (gap.high - gap.low);
  }
  return sum;
}

}  // namespace

bool isValid(const Aabb& box) {
  return box.min.allFinite() && box.max.allFinite() && (box.min.array() <= box.max.array()).all();
}

float roundedDown(double value) {
  // Works like std::nextafter, but without a function call and without a branch, because every box needs six of these
  // roundings and a processor cannot predict which of them change a digit.
  const float nearest = static_cast<float>(value);
  std::int32_t bits;
  std::memcpy(&bits, &nearest, sizeof bits);
  // The position of a number among all floats, where -0 comes directly before +0. The conversion keeps the sign, so a
  // value is never below its nearest float if this is +0.
  const auto position = [](std::int32_t of) { return of ^ ((of >> 31) & std::numeric_limits<std::int32_t>::max()); };
  bits = position(position(bits) - static_cast<std::int32_t>(static_cast<double>(nearest) > value));
  float below;
  std::memcpy(&below, &bits, sizeof below);
  return below;
}

float roundedUp(double value) { return -roundedDown(-value); }

double distance(const Aabb& a, const Aabb& b) { return std::sqrt(squaredDistance(a, b)); }

bool withinDistance(const Aabb& a, const Aabb& b, double margin) {
  if (margin > 1e40) return true;  // no two floats are that far apart, and margin² might overflow
  const double squared = squaredDistance(a, b);
  const double limit = margin * margin;
  constexpr double kSquareRounding = 1e-14, kUnderflow = 1e-290;  // far above the errors of `squared` and `limit`
  const double doubt = kSquareRounding * limit + kUnderflow;
  if (squared < limit - doubt) return true;
  if (squared > limit + doubt) return false;
  return exactComparison(a, b, margin) <= 0.0;
}

Aabb grown(const Aabb& box, double by) {
  constexpr double kSumRounding = 1e-15;  // more than the rounding error of a sum of two doubles
  Aabb result;
  for (int axis = 0; axis < 3; ++axis) {
    const double low = box.min[axis], high = box.max[axis];
    result.min[axis] = roundedDown(low - by - kSumRounding * (std::abs(low) + by));
    result.max[axis] = roundedUp(high + by + kSumRounding * (std::abs(high) + by));
  }
  return result;
}

double penetrationDepth(const Eigen::AlignedBox3d& first, const Eigen::AlignedBox3d& second) {
  // The lengths of the moves of `second`, up or down along each axis, that separate the two boxes.
  const Eigen::Vector3d up = first.max() - second.min(), down = second.max() - first.min();
  return std::max(0.0, up.cwiseMin(down).minCoeff());
}

BoxPoints nearestPoints(const Eigen::AlignedBox3d& first, const Eigen::AlignedBox3d& second) {
  const Eigen::Vector3d low = first.min().cwiseMax(second.min()), high = first.max().cwiseMin(second.max());
  BoxPoints points;
  for (int axis = 0; axis < 3; ++axis) {
    const bool apart = low[axis] > high[axis], first_is_lower = first.max()[axis] < second.min()[axis];
    const double middle = 0.5 * (low[axis] + high[axis]);
    points.on_first[axis] = !apart ? middle : first_is_lower ? high[axis] : low[axis];
    points.on_second[axis] = !apart ? middle : first_is_lower ? low[axis] : high[axis];
  }
  return points;
}

}  // namespace hgrid
