// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#include "hgrid_proximity/geometry/sphere.h"

namespace hgrid {

Eigen::Vector3d nearestPoint(const Aabb& box, const Eigen::Vector3d& point) {
  return point.cwiseMax(box.min.cast<double>()).cwiseMin(box.max.cast<double>());
}

}  // namespace hgrid
