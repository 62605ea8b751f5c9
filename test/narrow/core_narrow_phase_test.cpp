// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#include "hgrid_proximity/narrow/core_narrow_phase.h"

#include <gtest/gtest.h>

#include <cmath>
#include <stdexcept>

#include "narrow/convex_pair.h"
#include "narrow/core_narrow_phase.h"

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

/// Claim: a pair that cannot be measured counts as contact. A list of its contacts is never just empty, because that
/// would mean that there are none.
TEST(CoreNarrowPhase, AMeasurementThatFailsHasNoListOfContacts) {
  const auto narrow_phase = makeCoreNarrowPhase();
  const auto box = narrow_phase->solidOf(Shape::box({1, 1, 1}));
  const auto mesh = narrow_phase->solidOf(
      Shape::mesh(std::make_shared<TriangleMesh>(TriangleMesh{{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, {{0, 1, 2}}})));
  const Pose here = Pose::Identity(), nowhere = at(std::nan(""), 0, 0);
  for (const auto& solid : {box, mesh}) {
    EXPECT_EQ(narrow_phase->measure({*solid, here, 0.0}, {*box, nowhere, 0.0}, 1.0).status, Measure::failed);
    EXPECT_THROW(narrow_phase->contacts({*solid, here, 0.0}, {*box, nowhere, 0.0}, 5), std::runtime_error);
  }
}

/// Claim: if the bounds of a gap differ, the upper one is the distance, and the lower one decides about contact.
TEST(ConvexPair, UsesTheLowerBoundForWhatMustBeCertain) {
  const ConvexSolid ball(Shape::sphere(0.1));
  const Pose here = Pose::Identity(), there(Eigen::Translation3d(1.0, 0.0, 0.0));
  const Side a({ball, here, 0.0}), b({ball, there, 0.0});
  CoreGap gap;
  gap.lower = 0.5;
  gap.upper = 1.0;
  gap.on_second = there.translation();
  gap.normal = gap.apart_along = Eigen::Vector3d::UnitX();
  const Proximity early = answerByGap(a, b, there, gap, 1.0);
  EXPECT_EQ(early.status, Measure::apart);
  EXPECT_DOUBLE_EQ(early.distance, 0.8);
  EXPECT_DOUBLE_EQ(early.lower_bound, 0.3);
  const Proximity on_either_side = answerByGap(a, b, there, gap, 0.6);
  EXPECT_TRUE(std::isinf(on_either_side.distance));
  EXPECT_DOUBLE_EQ(on_either_side.lower_bound, 0.3);
  EXPECT_TRUE(std::isinf(answerByGap(a, b, there, gap, 0.2).lower_bound));
  gap.lower = 0.1;
  EXPECT_EQ(answerByGap(a, b, there, gap, 1.0).status, Measure::contact);
  gap.lower = 0.5;
  gap.normal.setZero();
  EXPECT_TRUE(answerByGap(a, b, there, gap, 1.0).normal.hasNaN()) << "a normal that is not known";
}

}  // namespace
}  // namespace test
}  // namespace hgrid
