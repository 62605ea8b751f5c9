// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#include "hgrid_proximity/geometry/half_space.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace hgrid {
namespace {

// As for the box of a shape, 64 units of rounding of all terms are more than the formulas and the composition of poses
// need together.
constexpr double kPlaneRounding = 64.0 * std::numeric_limits<double>::epsilon();

/// Returns the dot product. The order of its operations is fixed, so that every compiler computes the same value.
double dot(const Eigen::Vector3d& a, const Eigen::Vector3d& b) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }

}  // namespace

HalfSpace halfSpaceOf(const Pose& world_from_plane, double padding, const Eigen::Vector3d& origin) {
  HalfSpace result;
  result.normal = world_from_plane.linear().col(2);
  const Eigen::Vector3d at = world_from_plane.translation();
  result.offset = dot(result.normal, at - origin) + padding;
  result.rounding = kPlaneRounding * (dot(result.normal.cwiseAbs(), at.cwiseAbs() + origin.cwiseAbs()) + padding);
  return result;
}

double signedDistance(const HalfSpace& half_space, const Eigen::Vector3d& point) {
  return dot(half_space.normal, point) - half_space.offset;
}

Eigen::Vector3d deepestCorner(const HalfSpace& half_space, const Eigen::AlignedBox3d& box) {
  Eigen::Vector3d corner;
  for (int axis = 0; axis < 3; ++axis) {
    corner[axis] = half_space.normal[axis] < 0.0 ? box.max()[axis] : box.min()[axis];
  }
  return corner;
}

double distance(const HalfSpace& half_space, const Aabb& box) {
  const Eigen::Vector3d& normal = half_space.normal;
  double sum = 0.0, size = 0.0;
  for (int axis = 0; axis < 3; ++axis) {
    const double term = normal[axis] * static_cast<double>(normal[axis] < 0.0 ? box.max[axis] : box.min[axis]);
    sum += term;
    size += std::abs(term);
  }
  return std::max(0.0, sum - half_space.offset - half_space.rounding - kPlaneRounding * size);
}

}  // namespace hgrid
