// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

#include <memory>

#include "hgrid_proximity/geometry/shape.h"
#include "test/support/random.h"

namespace hgrid {
namespace test {

/// Returns a mesh with `corners` random vertices around a random point of its frame. Its triangles form an open fan.
inline std::shared_ptr<const TriangleMesh> randomMesh(Random& random, double size, int corners = 8) {
  auto mesh = std::make_shared<TriangleMesh>();
  const Eigen::Vector3d center(random.uniform(-size, size), random.uniform(-size, size), random.uniform(-size, size));
  for (int i = 0; i < corners; ++i) {
    mesh->vertices.push_back(center + Eigen::Vector3d(random.uniform(-size, size), random.uniform(-size, size),
                                                      random.uniform(-size, size)));
  }
  for (std::uint32_t i = 2; i < std::uint32_t(corners); ++i) mesh->triangles.push_back({0, i - 1, i});
  return mesh;
}

/// Returns a random shape of this kind. Its dimensions [m] lie between a hundredth of `size` and `size`; a plane has
/// none.
inline Shape randomShape(Random& random, ShapeKind kind, double size) {
  const auto measure = [&] { return random.logUniform(0.01 * size, size); };
  switch (kind) {
    case ShapeKind::sphere:
      return Shape::sphere(measure());
    case ShapeKind::box:
      return Shape::box({measure(), measure(), measure()});
    case ShapeKind::cylinder:
      return Shape::cylinder(measure(), measure());
    case ShapeKind::cone:
      return Shape::cone(measure(), measure());
    case ShapeKind::capsule:
      return Shape::capsule(measure(), measure());
    case ShapeKind::hull:
      return Shape::hull(randomMesh(random, size));
    case ShapeKind::mesh:
      return Shape::mesh(randomMesh(random, size));
    case ShapeKind::plane:
      return Shape::plane();
  }
  return Shape::sphere(size);
}

/// Returns a random shape that is not a plane.
inline Shape randomShape(Random& random, double size) {
  return randomShape(random, static_cast<ShapeKind>(random.between(1, 7)), size);
}

/// Returns a random pose, at most `far` [m] from the origin along each axis. Its rotation is arbitrary, a multiple of a
/// quarter turn, or tiny. For tiny rotations, formulas with 1 - cos² lose digits.
inline Pose randomPose(Random& random, double far) {
  Pose pose = Pose::Identity();
  Eigen::Vector3d axis(random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-1, 1));
  if (random.chance(0.3)) axis = Eigen::Vector3d::Unit(random.below(3));
  double angle = random.uniform(-3.2, 3.2);
  if (random.chance(0.3)) angle = random.between(-2, 2) * std::acos(0.0);
  if (random.chance(0.3)) angle = random.logUniform(1e-12, 1e-2);
  pose.linear() = Eigen::AngleAxisd(angle, axis.normalized()).toRotationMatrix();
  for (int k = 0; k < 3; ++k) pose.translation()[k] = random.uniform(-far, far);
  return pose;
}

}  // namespace test
}  // namespace hgrid
