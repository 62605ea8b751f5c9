// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

#include <vector>

#include "geometry/four_lanes.h"
#include "hgrid_proximity/geometry/pose.h"
#include "hgrid_proximity/geometry/sphere.h"
#include "narrow/inner_spheres.h"

namespace hgrid {

/// A sphere in floats [m]. Its radius is smaller by the rounding errors of its numbers.
struct SmallSphere {
  float center[3], radius;
};

/// Converts a sphere.
inline SmallSphere smallSphere(const Eigen::Vector3d& center, double radius) {
  const double rounding = 4e-7 * center.cwiseAbs().sum() + 2e-6 * radius;
  return {{static_cast<float>(center[0]), static_cast<float>(center[1]), static_cast<float>(center[2])},
          static_cast<float>(radius - rounding)};
}

/// Spheres inside a shape, four at a time.
struct FourSpheres {
  static constexpr std::size_t kFours = (kMostInnerSpheres + 3) / 4;

  /// Sets the spheres to those of a list, which has at most kMostInnerSpheres, at a pose.
  void fill(const std::vector<Sphere>& spheres, const Pose& pose) {
    count = spheres.size();
    const SmallSphere none{{0.0f, 0.0f, 0.0f}, -1e30f};
    for (std::size_t i = 0; i < (count + 3) / 4 * 4; ++i) {
      const SmallSphere sphere = i < count ? smallSphere(pose * spheres[i].center, spheres[i].radius) : none;
      for (std::size_t k = 0; k < 3; ++k) center[i / 4][k][i % 4] = sphere.center[k];
      radius[i / 4][i % 4] = sphere.radius;
    }
  }
  /// Returns one of the spheres.
  SmallSphere operator[](std::size_t i) const {
    return {{center[i / 4][0][i % 4], center[i / 4][1][i % 4], center[i / 4][2][i % 4]}, radius[i / 4][i % 4]};
  }
  /// Returns whether one of the spheres surely meets another sphere.
  bool meet(const SmallSphere& other) const {
    for (std::size_t i = 0; 4 * i < count; ++i) {
      const Four x = center[i][0] - allFour(other.center[0]), y = center[i][1] - allFour(other.center[1]),
                 z = center[i][2] - allFour(other.center[2]), reach = radius[i] + allFour(other.radius);
      const auto met = (reach > allFour(0.0f)) & (x * x + y * y + z * z < reach * reach);
      if (met[0] | met[1] | met[2] | met[3]) return true;
    }
    return false;
  }

  Four center[kFours][3], radius[kFours];  // a lane without a sphere has a negative radius
  std::size_t count = 0;
};

}  // namespace hgrid
