// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#include "hgrid_proximity/narrow/core_narrow_phase.h"

#include <gtest/gtest.h>

namespace hgrid {
namespace test {
namespace {

Pose at(double x, double y, double z) {
  Pose pose = Pose::Identity();
  pose.translation() << x, y, z;
  return pose;
}

Proximity measured(const Shape& first, const Shape& second, const Pose& world_from_second) {
  const auto narrow_phase = makeCoreNarrowPhase();
  const auto a = narrow_phase->solidOf(first), b = narrow_phase->solidOf(second);
  return narrow_phase->measure({*a, Pose::Identity(), 0.0}, {*b, world_from_second, 0.0}, 10.0);
}

TEST(CoreNarrowPhase, KnowsTheDepthOfRoundShapesWhoseCoresAreApart) {
  const Proximity spheres = measured(Shape::sphere(0.5), Shape::sphere(0.5), at(0.75, 0, 0));
  EXPECT_EQ(spheres.status, Measure::contact);
  EXPECT_EQ(spheres.distance, 0.0);
  EXPECT_NEAR(spheres.depth, 0.25, 1e-9);
  EXPECT_NEAR(spheres.normal.x(), 1.0, 1e-9);
  EXPECT_NEAR(spheres.on_first.x(), 0.5, 1e-9);
  EXPECT_NEAR(spheres.on_second.x(), 0.25, 1e-9);
}

TEST(CoreNarrowPhase, KnowsNoDepthOfCoresThatOverlap) {
  const Proximity boxes = measured(Shape::box({1, 1, 1}), Shape::box({1, 1, 1}), at(0.75, 0, 0));
  EXPECT_EQ(boxes.status, Measure::contact);
  EXPECT_EQ(boxes.distance, 0.0);
  EXPECT_TRUE(std::isnan(boxes.depth));
  EXPECT_TRUE(boxes.normal.hasNaN());
}

}  // namespace
}  // namespace test
}  // namespace hgrid
