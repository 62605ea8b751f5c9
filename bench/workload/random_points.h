// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

#include <Eigen/Core>

#include "bench/workload/random.h"

namespace hgrid {
namespace bench {

/// Returns a random point in a cube around the origin. `half` is half the edge of the cube.
inline Eigen::Vector3d cubePoint(Random& random, double half) {
  Eigen::Vector3d point;
  for (int axis = 0; axis < 3; ++axis) point[axis] = random.uniform(-half, half);
  return point;
}

/// Returns a random vector of length 1. All directions are equally likely.
inline Eigen::Vector3d direction(Random& random) {
  for (;;) {
    const Eigen::Vector3d point = cubePoint(random, 1.0);
    if (point.squaredNorm() <= 1.0 && point.squaredNorm() > 0.01) return point.normalized();
  }
}

}  // namespace bench
}  // namespace hgrid
