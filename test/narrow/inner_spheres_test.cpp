// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#include "narrow/inner_spheres.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "hgrid_proximity/narrow/core_narrow_phase.h"
#include "test/support/random.h"
#include "test/support/solids.h"

namespace hgrid {
namespace {

using namespace test;

/// Expects that a sphere lies inside a shape: points on its surface are in contact with the shape.
void expectInside(const NarrowPhase& narrow, const Solid& solid, const Sphere& sphere, Random& random) {
  const Pose identity = Pose::Identity();
  for (int i = 0; i < 60; ++i) {
    Eigen::Vector3d way;
    do {
      way << random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-1, 1);
    } while (way.norm() > 1.0 || way.norm() < 0.1);
    const Pose at(Eigen::Translation3d(sphere.center + (i == 0 ? 0.0 : sphere.radius) * way.normalized()));
    EXPECT_TRUE(isContact(narrow.measure({solid, identity, 0.0}, {*narrow.point(), at, 0.0}, 0.0).status))
        << at.translation().transpose();
  }
}

TEST(InnerSpheres, LieInsideTheirShapes) {
  const auto narrow = makeCoreNarrowPhase();
  Random random(5);
  const ShapeKind kinds[] = {ShapeKind::sphere, ShapeKind::box,     ShapeKind::cylinder,
                             ShapeKind::cone,   ShapeKind::capsule, ShapeKind::mesh};
  for (int i = 0; i < 120; ++i) {
    const Shape shape = randomSolid(random, kinds[i % 6]);
    SCOPED_TRACE(std::string(name(shape.kind())) + " " + std::to_string(i));
    const auto solid = narrow->solidOf(shape);
    const std::vector<Sphere> spheres = innerSpheresOf(shape, *solid);
    EXPECT_LE(spheres.size(), kMostInnerSpheres);
    EXPECT_TRUE(shape.kind() == ShapeKind::mesh || !spheres.empty());
    for (const Sphere& sphere : spheres) expectInside(*narrow, *solid, sphere, random);
    if (HasFailure()) return;
  }
}

TEST(InnerSpheres, FillACubeASphereAndALongMesh) {
  const auto narrow = makeCoreNarrowPhase();
  const auto largest = [&](const Shape& shape) {
    const std::vector<Sphere> spheres = innerSpheresOf(shape, *narrow->solidOf(shape));
    double radius = 0.0;
    for (const Sphere& sphere : spheres) radius = std::max(radius, sphere.radius);
    return radius;
  };
  EXPECT_NEAR(largest(Shape::box({0.2, 0.2, 0.2})), 0.1, 1e-6);
  EXPECT_NEAR(largest(Shape::sphere(0.3)), 0.3, 1e-6);
  EXPECT_NEAR(largest(Shape::cone(0.4, 0.3)), 0.15, 1e-6);
  const Shape stick = meshOf(boxMesh({0.1, 0.1, 2.0}));
  EXPECT_GT(largest(stick), 0.04);
  EXPECT_GT(innerSpheresOf(stick, *narrow->solidOf(stick)).size(), 6u) << "they are spread along the stick";
}

TEST(InnerSpheres, ThereAreNoneInAHullOrAPlane) {
  const auto narrow = makeCoreNarrowPhase();
  for (const Shape& shape : {Shape::plane(), Shape::hull(std::make_shared<const TriangleMesh>(ballMesh(1)))}) {
    EXPECT_TRUE(innerSpheresOf(shape, *narrow->solidOf(shape)).empty()) << name(shape.kind());
  }
}

TEST(InnerSpheres, ThoseOfAnOpenMeshAreCornersFarFromEachOther) {
  const auto narrow = makeCoreNarrowPhase();
  const TriangleMesh open = without(ballMesh(2), 3);
  const Shape shape = meshOf(open);
  const std::vector<Sphere> spheres = innerSpheresOf(shape, *narrow->solidOf(shape));
  ASSERT_EQ(spheres.size(), kMostInnerSpheres);
  for (std::size_t i = 0; i < spheres.size(); ++i) {
    EXPECT_EQ(spheres[i].radius, 0.0);
    EXPECT_EQ(std::count(open.vertices.begin(), open.vertices.end(), spheres[i].center), 1);
    for (std::size_t k = 0; k < i; ++k) EXPECT_GT((spheres[i].center - spheres[k].center).norm(), 0.3);
  }
}

}  // namespace
}  // namespace hgrid
