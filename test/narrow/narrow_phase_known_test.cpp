// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
//
// Simple cases that some libraries get wrong. Random tests found most of them. The right answers are easy to see.
#include <gtest/gtest.h>

#include "test/narrow/narrow_phase_judge.h"

namespace hgrid {
namespace test {
namespace {

Pose at(double x, double y, double z) {
  Pose pose = Pose::Identity();
  pose.translation() << x, y, z;
  return pose;
}

Pose turned(Pose pose, const Eigen::Vector3d& axis, double angle) {
  pose.linear() = Eigen::AngleAxisd(angle, axis.normalized()).toRotationMatrix();
  return pose;
}

Shape hullOf(std::vector<Eigen::Vector3d> vertices) {
  return Shape::hull(std::make_shared<TriangleMesh>(TriangleMesh{std::move(vertices), {}}));
}

void expectDistance(double expected, const Shape& first, const Shape& second, const Pose& world_from_second) {
  const Case placed{first, second, Pose::Identity(), world_from_second, 0.0, 0.0};
  SCOPED_TRACE(placed.text());
  EXPECT_LE(distanceOf(placed.first(), placed.second()).interval.errorOf(expected), 1e-9)
      << "the oracle disagrees with the expected distance";
  const Proximity answer = Trial(placed).measure();
  EXPECT_EQ(answer.status, expected > 0.0 ? Measure::apart : Measure::contact);
  EXPECT_NEAR(answer.distance, expected, 1e-6);
  Judge judge;
  judge.look(placed);
  judge.expectAllHeld();
}

// Many points of one side are equally near to the other shape. A search that stops as soon as a step brings no
// progress would stop too early here.
TEST(NarrowPhaseKnown, UprightThingsSideBySide) {
  for (const double off : {0.0, 1e-12, 1e-10, 1e-8}) {
    expectDistance(0.3, Shape::cylinder(1.0, 1.0), Shape::capsule(0.3, 0.2), at(1.5, off, -off));
    expectDistance(0.6, Shape::box({0.4, 0.4, 0.4}), Shape::capsule(0.1, 0.2), at(1.0, off, -off));
    expectDistance(0.4, Shape::cylinder(1.0, 0.3), Shape::cylinder(0.5, 0.3), at(1.0, off, -off));
    expectDistance(0.5, Shape::capsule(1.0, 0.3), Shape::capsule(0.5, 0.2), at(1.0, off, -off));
    expectDistance(0.75, Shape::box({1.0, 1.0, 1.0}), Shape::box({0.5, 0.5, 0.5}), at(1.5, off, -off));
  }
}

TEST(NarrowPhaseKnown, ThingsOnTopOfEachOther) {
  for (const double off : {0.0, 1e-12, 1e-10, 1e-8}) {
    expectDistance(0.25, Shape::cylinder(1.0, 1.0), Shape::cylinder(0.5, 0.2), at(off, -off, 1.0));
    expectDistance(0.25, Shape::box({1.0, 1.0, 1.0}), Shape::cone(0.5, 2.0), at(off, -off, 1.0));
    expectDistance(0.5, Shape::cone(1.0, 1.0), Shape::sphere(0.25), at(off, -off, 1.25));
    expectDistance(0.3, Shape::box({2.0, 2.0, 1.0}), Shape::capsule(0.5, 0.2), at(off, -off, 1.25));
  }
}

TEST(NarrowPhaseKnown, SmallBoxBesideAThinPlate) {
  for (const double angle : {0.0, 1e-12, 1e-10}) {
    expectDistance(0.11575, Shape::box({0.0005, 0.0133, 0.0007}), Shape::box({0.08, 0.002, 0.08}),
                   turned(at(0.156, angle, -angle), {-1.0, 0.9, -0.3}, angle));
  }
}

// A hull of a single point lies at the center of a sphere or a box, at an end of the axis of a capsule, at another
// point, or apart.
TEST(NarrowPhaseKnown, PointsThatMeet) {
  const Shape point = hullOf({{0, 0, 0}}), points = hullOf({{0, 0, 0}, {0, 0, 0}, {0, 0, 0}});
  for (const Shape& one : {point, points}) {
    expectDistance(0.0, Shape::sphere(0.1), one, at(0, 0, 0));
    expectDistance(0.0, Shape::capsule(0.2, 0.1), one, at(0, 0, 0.1));
    expectDistance(0.0, Shape::box({1, 1, 1}), one, at(0, 0, 0));
    expectDistance(0.0, point, one, at(0, 0, 0));
    expectDistance(2.0, point, one, at(2, 0, 0));
    expectDistance(1.9, Shape::sphere(0.1), one, at(2, 0, 0));
  }
}

TEST(NarrowPhaseKnown, CentersThatMeet) {
  const Shape shapes[] = {Shape::sphere(0.3),          Shape::box({0.2, 0.4, 0.6}),
                          Shape::cylinder(0.5, 0.2),   Shape::cone(0.5, 0.2),
                          Shape::capsule(0.5, 0.2),    hullOf(boxMesh({0.2, 0.4, 0.6}).vertices),
                          hullOf(ballMesh(1).vertices)};
  for (const Shape& one : shapes) {
    for (const Shape& other : shapes) expectDistance(0.0, one, other, at(0, 0, 0));
  }
}

// A thing that stands on a table only touches it. Although the shapes do not overlap, the normal must point up.
TEST(NarrowPhaseKnown, ThingsThatStandOnATableHaveANormal) {
  const Shape table = Shape::box({1.0, 1.0, 0.1});
  for (const double x : {0.0, 0.25, 0.4}) {
    for (const Shape& thing : {Shape::box({0.2, 0.2, 0.2}), Shape::cylinder(0.2, 0.1), Shape::cone(0.2, 0.1)}) {
      const Case placed{table, thing, Pose::Identity(), at(x, 0.1, 0.15), 0.0, 0.0};
      SCOPED_TRACE(placed.text());
      const Trial trial(placed);
      ASSERT_EQ(trial.measure().status, Measure::contact);
      const Contact contact = trial.contact();
      EXPECT_NEAR(contact.depth, 0.0, 1e-9);
      EXPECT_NEAR(contact.normal.z(), 1.0, 1e-9);
      EXPECT_NEAR(contact.point.z(), 0.05, 1e-9);
      EXPECT_NEAR(trial.contactSwapped().normal.z(), -1.0, 1e-9);
    }
  }
}

}  // namespace
}  // namespace test
}  // namespace hgrid
