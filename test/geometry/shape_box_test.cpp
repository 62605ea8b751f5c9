// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#include <gtest/gtest.h>

#include "hgrid_proximity/geometry/shape.h"
#include "test/support/shapes.h"

namespace hgrid {
namespace {

using test::Random;
using Wide = Eigen::Matrix<long double, 3, 1>;
using WideRotation = Eigen::Matrix<long double, 3, 3>;

/// Returns how far a rotated shape extends from its origin along an axis [m] (its support function). Computes in
/// extended precision. Uses the rotation matrix as it is, even if it is not exactly orthogonal.
long double reachAlong(const Shape& shape, const WideRotation& rotation, int axis, int sign) {
  const Wide row = rotation.row(axis).transpose() * (long double)sign;
  const long double across = std::sqrt(row[0] * row[0] + row[1] * row[1]), length = row.norm();
  const std::vector<double> d = shape.dimensions();
  switch (shape.kind()) {
    case ShapeKind::sphere:
      return d[0] * length;
    case ShapeKind::box:
      return 0.5L * (std::abs(row[0]) * d[0] + std::abs(row[1]) * d[1] + std::abs(row[2]) * d[2]);
    case ShapeKind::cylinder:
      return 0.5L * d[0] * std::abs(row[2]) + d[1] * across;
    case ShapeKind::cone:
      return std::max(0.5L * d[0] * row[2], d[1] * across - 0.5L * d[0] * row[2]);
    case ShapeKind::capsule:
      return 0.5L * d[0] * std::abs(row[2]) + d[1] * length;
    default:
      break;
  }
  long double most = -std::numeric_limits<long double>::infinity();
  for (const Eigen::Vector3d& vertex : shape.mesh()->vertices) {
    most = std::max(most, row.dot(vertex.cast<long double>()));
  }
  return most;
}

/// Returns a random point on the surface of a shape, in the frame of the shape.
Wide pointOf(const Shape& shape, Random& random) {
  const std::vector<double> d = shape.dimensions();
  const auto circle = [&](long double radius, long double z) {
    const long double turn = random.uniform(0, 6.3);
    return Wide(radius * std::cos(turn), radius * std::sin(turn), z);
  };
  const auto ball = [&](long double radius) {
    const long double z = random.uniform(-1, 1);
    return Wide(radius * circle(std::sqrt(1 - z * z), z));
  };
  switch (shape.kind()) {
    case ShapeKind::sphere:
      return ball(d[0]);
    case ShapeKind::box: {
      Wide point;
      for (int k = 0; k < 3; ++k) point[k] = d[std::size_t(k)] * (random.below(2) - 0.5L);
      return point;
    }
    case ShapeKind::cylinder:
      return circle(d[1], d[0] * (random.below(2) - 0.5L));
    case ShapeKind::cone:
      return random.chance(0.2) ? Wide(0, 0, 0.5L * d[0]) : circle(d[1], -0.5L * d[0]);
    case ShapeKind::capsule: {
      Wide point = ball(d[1]);
      point[2] += (point[2] < 0 ? -0.5L : 0.5L) * d[0];
      return point;
    }
    default:
      break;
  }
  const auto& vertices = shape.mesh()->vertices;
  return vertices[std::size_t(random.below(int(vertices.size())))].cast<long double>();
}

TEST(BoxOfShape, ContainsTheShapeAndIsTightOnAllSixFaces) {
  for (unsigned seed = 1; seed <= 20000; ++seed) {
    Random random(seed);
    const double size = random.logUniform(0.05, 50), far = random.chance(0.5) ? size : random.logUniform(1, 1e6);
    const Shape shape = test::randomShape(random, size);
    const Pose pose = test::randomPose(random, far);
    const double padding = random.chance(0.5) ? 0.0 : random.logUniform(1e-4, 1.0);
    Eigen::Vector3d origin = Eigen::Vector3d::Zero();
    if (random.chance(0.5)) origin = pose.translation() + Eigen::Vector3d::Constant(random.uniform(-1, 1));
    const Aabb box = boxOf(shape, pose, padding, origin);
    SCOPED_TRACE("seed " + std::to_string(seed) + ", " + name(shape.kind()));
    const WideRotation rotation = pose.linear().cast<long double>();
    for (int k = 0; k < 3; ++k) {
      const long double center = (long double)pose.translation()[k] - origin[k];
      const long double high = center + reachAlong(shape, rotation, k, 1) + padding;
      const long double low = center - reachAlong(shape, rotation, k, -1) - padding;
      // boxOf() promises that the error is at most 64 rounding units of these terms. After that, it rounds to the next
      // float.
      const long double terms = std::abs(pose.translation()[k]) + std::abs(origin[k]) + shape.reach() + padding;
      const long double slack = 3e-14L * terms + 1e-44L;
      ASSERT_GE(box.max[k], high);
      ASSERT_LE(box.min[k], low);
      ASSERT_LE(test::stepped(box.max[k], -1), high + slack);
      ASSERT_GE(test::stepped(box.min[k], 1), low - slack);
    }
  }
}

TEST(BoxOfShape, ContainsPointsSampledFromThePaddedSurface) {
  for (unsigned seed = 1; seed <= 2000; ++seed) {
    Random random(seed);
    const Shape shape = test::randomShape(random, 1.0);
    const Pose pose = test::randomPose(random, 10.0);
    const double padding = random.chance(0.5) ? 0.0 : 0.1;
    const Aabb box = boxOf(shape, pose, padding, Eigen::Vector3d(1, 2, 3));
    SCOPED_TRACE("seed " + std::to_string(seed) + ", " + name(shape.kind()));
    for (int i = 0; i < 50; ++i) {
      const Wide offset = padding * Wide::Unit(random.below(3)) * (random.chance(0.5) ? 1 : -1);
      const Wide point = pose.linear().cast<long double>() * pointOf(shape, random) +
                         pose.translation().cast<long double>() + offset - Wide(1, 2, 3);
      for (int k = 0; k < 3; ++k) {
        ASSERT_GE(box.max[k], point[k]);
        ASSERT_LE(box.min[k], point[k]);
      }
    }
  }
}

// A wide disc is tilted by a tiny angle, less than the square root of the rounding unit. Its rim still rises.
TEST(BoxOfShape, ContainsTheRimOfAWideDiscThatIsHardlyTilted) {
  for (const double angle : {1e-9, 3e-9, 1e-8, 2e-8, 1e-7}) {
    for (const bool cone : {false, true}) {
      const Shape disc = cone ? Shape::cone(0.01, 100.0) : Shape::cylinder(0.01, 100.0);
      Pose pose = Pose::Identity();
      pose.linear() = Eigen::AngleAxisd(angle, Eigen::Vector3d::UnitX()).toRotationMatrix();
      const Aabb box = boxOf(disc, pose, 0.0, Eigen::Vector3d::Zero());
      const WideRotation rotation = pose.linear().cast<long double>();
      EXPECT_GE(box.max.z(), reachAlong(disc, rotation, 2, 1)) << angle << name(disc.kind());
      EXPECT_LE(box.min.z(), -reachAlong(disc, rotation, 2, -1)) << angle << name(disc.kind());
    }
  }
}

TEST(BoxOfShape, ReachIsTheFarthestPointFromTheOrigin) {
  for (unsigned seed = 1; seed <= 500; ++seed) {
    Random random(seed);
    const Shape shape = test::randomShape(random, 1.0);
    SCOPED_TRACE("seed " + std::to_string(seed) + ", " + name(shape.kind()));
    long double farthest = 0;
    for (int i = 0; i < 300; ++i) farthest = std::max(farthest, pointOf(shape, random).norm());
    ASSERT_LE(farthest, shape.reach() * (1 + 1e-15));
    ASSERT_GE(farthest, shape.reach() * 0.9);
  }
}

TEST(BoxOfShape, IsRelativeToTheOriginSoThatFarWorldsKeepTheirPrecision) {
  Pose pose = Pose::Identity();
  pose.translation() << 1e6 + 0.25, -1e6, 5e5;
  const Aabb box = boxOf(Shape::sphere(0.5), pose, 0.0, {1e6, -1e6, 5e5});
  EXPECT_NEAR(box.min.x(), -0.25, 1e-6);
  EXPECT_NEAR(box.max.x(), 0.75, 1e-6);
  EXPECT_NEAR(box.max.y(), 0.5, 1e-6);
}

}  // namespace
}  // namespace hgrid
