// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#include "narrow/inner_balls.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "hgrid_proximity/narrow/core_narrow_phase.h"
#include "test/support/random.h"
#include "test/support/solids.h"

namespace hgrid {
namespace {

using namespace test;

/// Expects that a ball lies inside a shape: points on its surface are in contact with the shape.
void expectInside(const NarrowPhase& narrow, const Solid& solid, const Sphere& ball, Random& random) {
  const Pose identity = Pose::Identity();
  for (int i = 0; i < 60; ++i) {
    Eigen::Vector3d way;
    do {
      way << random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-1, 1);
    } while (way.norm() > 1.0 || way.norm() < 0.1);
    const Pose at(Eigen::Translation3d(ball.center + (i == 0 ? 0.0 : ball.radius) * way.normalized()));
    EXPECT_TRUE(isContact(narrow.measure({solid, identity, 0.0}, {*narrow.point(), at, 0.0}, 0.0).status))
        << at.translation().transpose();
  }
}

TEST(InnerBalls, LieInsideTheirShapes) {
  const auto narrow = makeCoreNarrowPhase();
  Random random(5);
  const ShapeKind kinds[] = {ShapeKind::sphere, ShapeKind::box,     ShapeKind::cylinder,
                             ShapeKind::cone,   ShapeKind::capsule, ShapeKind::mesh};
  for (int i = 0; i < 120; ++i) {
    const Shape shape = randomSolid(random, kinds[i % 6]);
    SCOPED_TRACE(std::string(name(shape.kind())) + " " + std::to_string(i));
    const auto solid = narrow->solidOf(shape);
    const std::vector<Sphere> balls = innerBallsOf(shape, *solid);
    EXPECT_LE(balls.size(), kMostInnerBalls);
    EXPECT_TRUE(shape.kind() == ShapeKind::mesh || !balls.empty());
    for (const Sphere& ball : balls) expectInside(*narrow, *solid, ball, random);
    if (HasFailure()) return;
  }
}

TEST(InnerBalls, FillACubeASphereAndALongMesh) {
  const auto narrow = makeCoreNarrowPhase();
  const auto largest = [&](const Shape& shape) {
    const std::vector<Sphere> balls = innerBallsOf(shape, *narrow->solidOf(shape));
    double radius = 0.0;
    for (const Sphere& ball : balls) radius = std::max(radius, ball.radius);
    return radius;
  };
  EXPECT_NEAR(largest(Shape::box({0.2, 0.2, 0.2})), 0.1, 1e-6);
  EXPECT_NEAR(largest(Shape::sphere(0.3)), 0.3, 1e-6);
  EXPECT_NEAR(largest(Shape::cone(0.4, 0.3)), 0.15, 1e-6);
  const Shape stick = meshOf(boxMesh({0.1, 0.1, 2.0}));
  EXPECT_GT(largest(stick), 0.04);
  EXPECT_GT(innerBallsOf(stick, *narrow->solidOf(stick)).size(), 6u) << "they are spread along the stick";
}

TEST(InnerBalls, ThereAreNoneInAHullOrAPlane) {
  const auto narrow = makeCoreNarrowPhase();
  for (const Shape& shape : {Shape::plane(), Shape::hull(std::make_shared<const TriangleMesh>(ballMesh(1)))}) {
    EXPECT_TRUE(innerBallsOf(shape, *narrow->solidOf(shape)).empty()) << name(shape.kind());
  }
}

TEST(InnerBalls, ThoseOfAnOpenMeshAreCornersFarFromEachOther) {
  const auto narrow = makeCoreNarrowPhase();
  const TriangleMesh open = without(ballMesh(2), 3);
  const Shape shape = meshOf(open);
  const std::vector<Sphere> balls = innerBallsOf(shape, *narrow->solidOf(shape));
  ASSERT_EQ(balls.size(), kMostInnerBalls);
  for (std::size_t i = 0; i < balls.size(); ++i) {
    EXPECT_EQ(balls[i].radius, 0.0);
    EXPECT_EQ(std::count(open.vertices.begin(), open.vertices.end(), balls[i].center), 1);
    for (std::size_t k = 0; k < i; ++k) EXPECT_GT((balls[i].center - balls[k].center).norm(), 0.3);
  }
}

}  // namespace
}  // namespace hgrid
