// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

#include <algorithm>
#include <cmath>
#include <vector>

#include "geometry/four_lanes.h"
#include "geometry/rounding.h"
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
  constexpr double kOfRadius = 2e-6;  // for the sums of radii in floats
  const double rounding = kFloatRounding * center.cwiseAbs().sum() + kOfRadius * radius;
  return {{static_cast<float>(center[0]), static_cast<float>(center[1]), static_cast<float>(center[2])},
          static_cast<float>(radius - rounding)};
}

/// Spheres inside a shape, four at a time, in floats [m]. Their radii are smaller by the rounding errors of all
/// numbers.
struct FourSpheres {
  static constexpr std::size_t kFours = (kMostInnerSpheres + 3) / 4;

  FourSpheres() = default;
  /// Converts spheres. @param spheres  at most kMostInnerSpheres spheres [m]
  explicit FourSpheres(const std::vector<Sphere>& spheres) : count(spheres.size()) {
    const SmallSphere none{{0.0f, 0.0f, 0.0f}, -1e30f};
    Eigen::AlignedBox3d bounds;
    for (std::size_t i = 0; i < (count + 3) / 4 * 4; ++i) {
      const SmallSphere sphere = i < count ? smallSphere(spheres[i].center, spheres[i].radius) : none;
      for (std::size_t k = 0; k < 3; ++k) center[i / 4][k][i % 4] = sphere.center[k];
      radius[i / 4][i % 4] = sphere.radius;
      if (i < count) bounds.extend(spheres[i].center);
    }
    if (count == 0) return;
    const Eigen::Vector3d middle = bounds.center();
    double reach = 0.0;
    for (const Sphere& sphere : spheres) reach = std::max(reach, (sphere.center - middle).norm() + sphere.radius);
    for (std::size_t k = 0; k < 3; ++k) around.center[k] = static_cast<float>(middle[static_cast<Eigen::Index>(k)]);
    around.radius = static_cast<float>(reach);
  }

  /// Returns these spheres at a pose. The translation of the pose must be relative to the origin of the snapshot.
  FourSpheres at(const Pose& pose) const {
    float turn[3][3], shift[3], rounding = 0.0f;
    for (std::size_t row = 0; row < 3; ++row) {
      const auto r = static_cast<Eigen::Index>(row);
      for (Eigen::Index k = 0; k < 3; ++k) turn[row][k] = static_cast<float>(pose.linear()(r, k));
      shift[row] = static_cast<float>(pose.translation()[r]);
      rounding += kRounding * std::abs(shift[row]);
    }
    FourSpheres result;
    result.count = count;
    for (std::size_t i = 0; 4 * i < count; ++i) {
      const Four &x = center[i][0], &y = center[i][1], &z = center[i][2];
      for (std::size_t row = 0; row < 3; ++row) {
        result.center[i][row] = turn[row][0] * x + turn[row][1] * y + turn[row][2] * z + shift[row];
      }
      result.radius[i] =
          radius[i] - (greatest(x, -x) + greatest(y, -y) + greatest(z, -z)) * kRounding - allFour(rounding);
    }
    for (std::size_t row = 0; row < 3; ++row) {
      result.around.center[row] = turn[row][0] * around.center[0] + turn[row][1] * around.center[1] +
                                  turn[row][2] * around.center[2] + shift[row];
    }
    result.around.radius = around.radius;
    return result;
  }

  /// Returns whether one of the spheres surely meets another sphere.
  bool meet(const SmallSphere& other) const {
    if (!mayMeet(other)) return false;
    for (std::size_t i = 0; 4 * i < count; ++i) {
      if (meeting(i, other) != 0) return true;
    }
    return false;
  }
  /// Returns whether one of the spheres surely meets one of the others.
  bool meet(const FourSpheres& others) const {
    if (!mayMeet(others.around)) return false;
    for (std::size_t i = 0; 4 * i < others.count; ++i) {
      unsigned candidates = others.meeting(i, around);
      for (std::size_t lane = 0; candidates != 0; ++lane, candidates >>= 1) {
        if ((candidates & 1u) == 0) continue;
        const SmallSphere other{{others.center[i][0][lane], others.center[i][1][lane], others.center[i][2][lane]},
                                others.radius[i][lane]};
        if (meet(other)) return true;
      }
    }
    return false;
  }

  Four center[kFours][3], radius[kFours];  // a lane without a sphere has a negative radius
  SmallSphere around{};  // bounding sphere of all spheres; its radius is not reduced; zero if there are none
  std::size_t count = 0;

 private:
  // Bound of the rounding errors of at(), relative to the sum of the absolute coordinates.
  static constexpr float kRounding = 1e-6f;

  /// Returns whether a sphere overlaps the bounding sphere. Rounding may make the answer wrong: after a wrong true, all
  /// spheres are tested; after a wrong false, the narrow phase measures the shapes.
  bool mayMeet(const SmallSphere& other) const {
    const float x = around.center[0] - other.center[0], y = around.center[1] - other.center[1],
                z = around.center[2] - other.center[2], reach = around.radius + other.radius;
    return x * x + y * y + z * z < reach * reach;
  }
  /// Returns one bit for each sphere of a group of four: whether it surely meets another sphere.
  unsigned meeting(std::size_t i, const SmallSphere& other) const {
    const Four x = center[i][0] - allFour(other.center[0]), y = center[i][1] - allFour(other.center[1]),
               z = center[i][2] - allFour(other.center[2]), reach = radius[i] + allFour(other.radius);
    return bitsOf(reinterpret_cast<FourCounts>((reach > allFour(0.0f)) & (x * x + y * y + z * z < reach * reach)));
  }
};

}  // namespace hgrid
