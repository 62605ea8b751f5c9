// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#include "hgrid_proximity/geometry/oriented_box.h"

#include <algorithm>
#include <limits>

#include "geometry/double_double.h"

namespace hgrid {

namespace {

/// Returns the cross product of two vectors, to a few units in the last place also if they are almost parallel.
Eigen::Vector3d preciseCross(const Eigen::Vector3d& a, const Eigen::Vector3d& b) {
  Eigen::Vector3d result;
  for (int i = 0; i < 3; ++i) {
    const int k = (i + 1) % 3, m = (i + 2) % 3;
    result[i] = static_cast<double>(DoubleDouble::product(a[k], b[m]) - DoubleDouble::product(a[m], b[k]));
  }
  return result;
}

}  // namespace

double penetrationDepth(const OrientedBox& first, const OrientedBox& second) {
  // Squared sine of an angle. The cross product of edges with a smaller angle needs more digits.
  constexpr double kAlmostParallel = 1e-8;
  const Eigen::Matrix3d a = first.world_from_box.linear(), b = second.world_from_box.linear();
  const Eigen::Vector3d between = second.world_from_box.translation() - first.world_from_box.translation();
  double depth = std::numeric_limits<double>::infinity();
  const auto separateAlong = [&](const Eigen::Vector3d& direction) {
    const double reach = 0.5 * first.size.dot((a.transpose() * direction).cwiseAbs()) +
                         0.5 * second.size.dot((b.transpose() * direction).cwiseAbs());
    depth = std::min(depth, reach - std::abs(between.dot(direction)));
  };
  for (int i = 0; i < 3; ++i) {
    separateAlong(a.col(i));
    separateAlong(b.col(i));
    for (int j = 0; j < 3; ++j) {
      Eigen::Vector3d cross = a.col(i).cross(b.col(j));
      if (!(cross.squaredNorm() > kAlmostParallel)) cross = preciseCross(a.col(i), b.col(j));
      const double length = cross.norm();
      if (length > 0.0) separateAlong(cross / length);
    }
  }
  return std::max(0.0, depth);
}

}  // namespace hgrid
