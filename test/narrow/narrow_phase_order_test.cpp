// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
//
// The answer does not depend on the order of the two shapes, even if the shapes are hard to tell apart.
#include <gtest/gtest.h>

#include <algorithm>

#include "test/narrow/narrow_phase_judge.h"

namespace hgrid {
namespace test {
namespace {

Shape hullOf(const TriangleMesh& mesh) { return Shape::hull(std::make_shared<TriangleMesh>(mesh)); }

/// Returns pairs of shapes of the same kind that reach equally far from their origins. Some pairs of meshes differ only
/// in the order of their triangles, or not at all.
std::vector<std::pair<Shape, Shape>> twins() {
  TriangleMesh lump = boxMesh({0.3, 0.5, 0.7}), turned = boxMesh({0.5, 0.7, 0.3}), rolled = lump;
  std::rotate(rolled.triangles.begin(), rolled.triangles.begin() + 1, rolled.triangles.end());
  std::vector<std::pair<Shape, Shape>> twins = {{Shape::box({0.3, 0.5, 0.7}), Shape::box({0.5, 0.7, 0.3})},
                                                {Shape::cylinder(0.6, 0.4), Shape::cylinder(0.8, 0.3)},
                                                {Shape::cone(0.6, 0.4), Shape::cone(0.8, 0.3)},
                                                {Shape::capsule(0.5, 0.25), Shape::capsule(0.75, 0.125)},
                                                {hullOf(lump), hullOf(turned)},
                                                {meshOf(lump), meshOf(turned)},
                                                {meshOf(lump), meshOf(lump)},
                                                {meshOf(lump), meshOf(rolled)}};
  return twins;
}

TEST(NarrowPhaseOrder, OfTwinsDoesNotMatter) {
  Random random(14);
  for (const auto& [one, other] : twins()) {
    SCOPED_TRACE(name(one.kind()));
    for (const double far : {0.0, 0.3, 1.0}) {
      for (int i = 0; i < 100; ++i) {
        const Pose pose = randomPose(random, 1.0);
        Case placed{one, other, pose, pose, 0.0, 0.0};
        placed.world_from_second.translation() += far * randomPose(random, 1.0).linear().col(0);
        const Trial trial(placed);
        EXPECT_TRUE(isSameInOtherOrder(placed, trial.measure(), trial.measureSwapped())) << placed.text();
        if (HasFailure()) return;
      }
    }
  }
}

// Two solids that are created from the same shape give the same answers.
TEST(NarrowPhaseOrder, OfAShapeWithItselfDoesNotMatter) {
  Random random(15);
  for (const ShapeKind kind : testedKinds()) {
    const Shape shape = randomSolid(random, kind);
    for (int i = 0; i < 100; ++i) {
      const Case placed{shape, shape, randomPose(random, 1.0), randomPose(random, 1.0), 0.01, 0.02};
      const Trial trial(placed);
      const Proximity answer = trial.measure();
      ASSERT_TRUE(isSameInOtherOrder(placed, answer, trial.measureSwapped())) << placed.text();
      ASSERT_TRUE(isSame(answer, Trial(placed).measure())) << "with newly created solids: " << placed.text();
    }
  }
}

}  // namespace
}  // namespace test
}  // namespace hgrid
