// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#include "hgrid_proximity/geometry/oriented_box.h"

#include <algorithm>
#include <limits>

namespace hgrid {

double penetrationDepth(const OrientedBox& first, const OrientedBox& second) {
  // Squared sine of an angle. Two edges with a smaller angle are parallel, so their cross product gives no direction.
  constexpr double kParallel = 1e-12;
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
      const Eigen::Vector3d cross = a.col(i).cross(b.col(j));
      if (cross.squaredNorm() > kParallel) separateAlong(cross.normalized());
    }
  }
  return std::max(0.0, depth);
}

}  // namespace hgrid
