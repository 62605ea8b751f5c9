// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#include "partitions/query_shape.h"

#include <algorithm>
#include <cmath>

namespace hgrid {
namespace book {
namespace {

/// A box of floats around two points and everything within `around` [m] of them.
Aabb boxAround(const Eigen::Vector3d& a, const Eigen::Vector3d& b, double around) {
  Aabb box;
  for (int axis = 0; axis < 3; ++axis) {
    box.min[axis] = roundedDown(std::min(a[axis], b[axis]) - around);
    box.max[axis] = roundedUp(std::max(a[axis], b[axis]) + around);
  }
  return box;
}

double largestCoordinate(const Segment& segment) {
  return std::max(segment.from.cwiseAbs().maxCoeff(), segment.to.cwiseAbs().maxCoeff()) + segment.radius;
}

}  // namespace

QueryShape::QueryShape(const Aabb& box) : kind_(Kind::box), bounds_(box) {}

QueryShape::QueryShape(const Sphere& sphere) : kind_(Kind::sphere), sphere_(sphere) {
  radius_with_slack_ = sphere.radius + 4.0 * roundingSlack(sphere.center.cwiseAbs().maxCoeff() + sphere.radius);
  bounds_ = boxAround(sphere.center, sphere.center, radius_with_slack_);
}

QueryShape::QueryShape(const Segment& segment) : kind_(Kind::segment), segment_(segment) {
  radius_with_slack_ = segment.radius + 8.0 * roundingSlack(largestCoordinate(segment));
  bounds_ = boxAround(segment.from, segment.to, radius_with_slack_);
  step_ = segment.to - segment.from;
}

int QueryShape::longAxis() const {
  int axis = 0;
  step_.cwiseAbs().maxCoeff(&axis);
  return axis;
}

Aabb QueryShape::slice(int axis, double low, double high) const {
  if (kind_ == Kind::segment && std::abs(step_[axis]) > kLeastStep) {
    // A sphere that moves along the segment reaches into the slice only while its center is within
    // `radius_with_slack_` of the slice. The slack is far above the rounding errors of these fractions.
    double first = (low - radius_with_slack_ - segment_.from[axis]) / step_[axis];
    double last = (high + radius_with_slack_ - segment_.from[axis]) / step_[axis];
    if (first > last) std::swap(first, last);
    first = std::clamp(first, 0.0, 1.0);
    last = std::clamp(last, 0.0, 1.0);
    return boxAround(segment_.from + first * step_, segment_.from + last * step_, radius_with_slack_);
  }
  Aabb part = bounds_;
  part.min[axis] = std::max(part.min[axis], roundedDown(low));
  part.max[axis] = std::min(part.max[axis], roundedUp(high));
  return part;
}

bool QueryShape::mayTouch(const Aabb& region) const {
  if (!overlap(bounds_, region)) return false;
  if (kind_ == Kind::box) return true;
  if (kind_ == Kind::sphere)
    return squaredDistance(region, sphere_.center) <=
           radius_with_slack_ * radius_with_slack_ * (1.0 + kFractionRounding);
  // The line from + t * step is clipped by the slabs of the region, which are grown by the thickness of the segment.
  double enter = 0.0, leave = 1.0;
  for (int axis = 0; axis < 3; ++axis) {
    const double low = region.min[axis] - radius_with_slack_ - segment_.from[axis];
    const double high = region.max[axis] + radius_with_slack_ - segment_.from[axis];
    if (std::abs(step_[axis]) <= kLeastStep) continue;  // the test of `bounds_` above has decided this axis
    const double a = low / step_[axis], b = high / step_[axis];
    enter = std::max(enter, std::min(a, b));
    leave = std::min(leave, std::max(a, b));
  }
  return enter <= leave + kFractionRounding;
}

}  // namespace book
}  // namespace hgrid
