// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

#include <Eigen/Core>

#include "bench/workload/random.h"

namespace hgrid {
namespace bench {

/// A point of a cube around zero.
inline Eigen::Vector3d cubePoint(Random& random, double half) {
  Eigen::Vector3d point;
  for (int axis = 0; axis < 3; ++axis) point[axis] = random.uniform(-half, half);
  return point;
}

/// A direction, all alike; its length is 1.
inline Eigen::Vector3d direction(Random& random) {
  for (;;) {
    const Eigen::Vector3d point = cubePoint(random, 1.0);
    if (point.squaredNorm() <= 1.0 && point.squaredNorm() > 0.01) return point.normalized();
  }
}

}  // namespace bench
}  // namespace hgrid
