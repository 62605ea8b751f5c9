// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

#include <cmath>
#include <memory>

#include "test/narrow/narrow_phase_cases.h"
#include "test/support/convex.h"
#include "test/support/worlds.h"

namespace hgrid {
namespace test {

/// Which shapes AimedCases generates.
struct AimedShapes {
  double thinnest_side = 1e-4;  ///< the shortest side of a shape, as a part of its size
  double flattest_hull = 1e-6;  ///< the height of the flattest hull, as a part of its size
  bool padded = true;           ///< whether some shapes have a padding
};

/// Generates pairs of convex shapes whose features are brought as near to each other as doubles can express: rims,
/// tips, edges that are almost parallel, thin hulls, plates and needles.
///
/// Along the direction in which the second shape is placed, the gap of the two is 0 or 1e-16 to 1 of their size, of
/// either sign. So it is the distance of many pairs, and a lower bound of the distance of all.
class AimedCases {
 public:
  /// @param size  [m] the longest side of a shape
  AimedCases(unsigned seed, double size, const AimedShapes& shapes = {})
      : random_(seed), size_(size), shapes_(shapes) {}

  Case next() {
    Case placed{shape(), shape(), Pose::Identity(), Pose::Identity(), padding(), padding()};
    placed.world_from_first.linear() = rotation();
    placed.world_from_second.linear() = rotation();
    const Eigen::Vector3d direction = aim(placed);
    const Convex first(placed.first_shape, placed.world_from_first, placed.first_padding),
        second(placed.second_shape, placed.world_from_second, placed.second_padding);
    const double gap =
        random_.chance(0.1) ? 0.0 : random_.logUniform(1e-16, 1.0) * size_ * (random_.chance(0.3) ? -1 : 1);
    const Real apart = gap + first.radius() + second.radius();
    const Vector3r along = direction.cast<Real>(), to = first.support(along) - second.support(-along) + apart * along;
    placed.world_from_second.translation() = to.cast<double>();
    if (random_.chance(0.5)) {
      const Eigen::Vector3d aside = randomVector(random_, -1.0, 1.0).cross(direction);
      placed.world_from_second.translation() += random_.logUniform(1e-12, 1.0) * size_ * aside;
    }
    return placed;
  }
  Random& random() { return random_; }

 private:
  double length() {
    return size_ * (random_.chance(0.3) ? random_.uniform(0.3, 1.0) : random_.logUniform(shapes_.thinnest_side, 1.0));
  }
  double padding() { return !shapes_.padded || random_.chance(0.6) ? 0.0 : size_ * random_.logUniform(1e-6, 0.1); }

  Shape shape() {
    const ShapeLimits any_size{1e-9, 1e7};
    switch (random_.below(6)) {
      case 0:
        return Shape::sphere(length(), any_size);
      case 1:
        return Shape::box({length(), length(), length()}, any_size);
      case 2:
        return Shape::cylinder(length(), length(), any_size);
      case 3:
        return Shape::cone(length(), length(), any_size);
      case 4:
        return Shape::capsule(length(), length(), any_size);
      default: {
        auto mesh = std::make_shared<TriangleMesh>();
        const double flat = random_.chance(0.5) ? 1.0 : random_.logUniform(shapes_.flattest_hull, 1.0);
        for (int i = 4 + random_.below(12); i > 0; --i) {
          Eigen::Vector3d point = 0.5 * size_ * randomVector(random_, -1.0, 1.0);
          point.z() *= flat;
          mesh->vertices.push_back(point);
        }
        return Shape::hull(mesh, any_size);
      }
    }
  }

  /// Returns a rotation: none, by a multiple of 45 degrees and a tiny angle, or any.
  Eigen::Matrix3d rotation() {
    if (random_.chance(0.25)) return Eigen::Matrix3d::Identity();
    if (random_.chance(0.4)) return randomPose(random_, 1.0).linear();
    const Eigen::AngleAxisd turn(0.25 * M_PI * random_.below(8), Eigen::Vector3d::Unit(random_.below(3)));
    const Eigen::AngleAxisd tiny(random_.logUniform(1e-16, 1e-3), randomVector(random_, -1.0, 1.0).normalized());
    return (turn * tiny).toRotationMatrix();
  }

  /// Returns a direction from the first shape to the second, often along an axis or almost along it.
  Eigen::Vector3d aim(const Case& placed) {
    const Eigen::Vector3d axis =
        placed.world_from_first.linear().col(random_.below(3)) * (random_.chance(0.5) ? 1 : -1);
    if (random_.chance(0.4)) return axis;
    const double off = random_.chance(0.5) ? random_.logUniform(1e-16, 1e-2) : 10.0;
    return (axis + off * randomVector(random_, -1.0, 1.0)).normalized();
  }

  Random random_;
  const double size_;
  const AimedShapes shapes_;
};

}  // namespace test
}  // namespace hgrid
