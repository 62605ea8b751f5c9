// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
//
// Compares how far boxes and balls are apart in floats with their distances in doubles.
#include "queries/states/tilted_box.h"

#include <gtest/gtest.h>

#include "queries/states/robot_shapes.h"
#include "test/queries/states/state_worlds.h"

namespace hgrid {
namespace {

using namespace test;

/// A ball or a box at a pose.
struct Placed {
  Placed(Random& random, bool is_ball, double size, double away)
      : is_ball(is_ball), radius(size), pose(randomPose(random, size)) {
    pose.translation() += Eigen::Vector3d::Constant(away);
    const Eigen::Vector3d edges(size, random.uniform(0.2, 1.0) * size, random.uniform(0.2, 1.0) * size);
    half = 0.5 * edges;
    const BodyShape shape = solidShape(is_ball ? Shape::sphere(radius) : Shape::box(edges));
    box = tiltedBoxOf(shape, pose, 4e-7);
  }

  const bool is_ball;
  double radius;
  Pose pose;
  Eigen::Vector3d half;
  TiltedBox<float> box;
};

/// Returns the distance [m] of the center of a ball from a box. Inside the box, it is minus the distance from the
/// nearest face.
double distance(const Placed& box, const Eigen::Vector3d& center) {
  const Eigen::Vector3d beyond = (box.pose.inverse() * center).cwiseAbs() - box.half;
  return beyond.cwiseMax(0.0).norm() + std::min(0.0, beyond.maxCoeff());
}

/// Returns the distance [m] of two shapes, of which at least one is a ball.
double distance(const Placed& a, const Placed& b) {
  if (!a.is_ball) return distance(b, a);
  const double from_center =
      b.is_ball ? (a.pose.translation() - b.pose.translation()).norm() - b.radius : distance(b, a.pose.translation());
  return from_center - a.radius;
}

TEST(TiltedBox, KnowsWhetherItHasABall) {
  Random random(1);
  EXPECT_TRUE(Placed(random, true, 0.1, 0.0).box.is_ball);
  EXPECT_FALSE(Placed(random, false, 0.1, 0.0).box.is_ball);
}

TEST(TiltedBox, BoundsTheDistanceOfABallFromBelowAndClosely) {
  Random random(2);
  int apart = 0, overlapping = 0, inside = 0;
  for (int i = 0; i < 20000; ++i) {
    const double away = random.chance(0.2) ? 1000.0 : 0.0, size = std::pow(10.0, random.uniform(-2.0, 0.5));
    const bool first = random.chance(0.5), second = !first || random.chance(0.5);
    const Placed a(random, first, size, away), b(random, second, random.uniform(0.1, 2.0) * size, away);
    const double truth = distance(a, b), tolerance = 5e-5 * size + 2e-6 * away;
    const float gap = separationOf(a.box, b.box, 0.0f).along_faces;
    ASSERT_LE(static_cast<double>(gap), truth) << "a bound from below";
    ASSERT_GE(static_cast<double>(gap), truth - tolerance);
    ++(truth > 0.0 ? apart : overlapping);
    inside += !first && distance(a, b.pose.translation()) < 0.0 ? 1 : 0;

    TiltedBox<Four> four;  // lane 2 has the box of `a`; the boxes of the other lanes are at the origin
    for (std::size_t k = 0; k < 3; ++k) {
      for (std::size_t axis = 0; axis < 3; ++axis) four.axes[axis][k] = Four{0, 0, a.box.axes[axis][k], 0};
      four.center[k] = Four{0, 0, a.box.center[k], 0};
      four.half[k] = allFour(a.box.half[k]);
    }
    four.is_ball = first;
    TiltedBox<Four> other;
    for (std::size_t k = 0; k < 3; ++k) {
      for (std::size_t axis = 0; axis < 3; ++axis) other.axes[axis][k] = allFour(b.box.axes[axis][k]);
      other.center[k] = allFour(b.box.center[k]);
      other.half[k] = allFour(b.box.half[k]);
    }
    other.is_ball = second;
    ASSERT_NEAR(separationOf(four, other, allFour(0.0f)).along_faces[2], gap, 1e-6f * static_cast<float>(size + away));
  }
  EXPECT_GT(apart, 3000);
  EXPECT_GT(overlapping, 3000);
  EXPECT_GT(inside, 300);
}

}  // namespace
}  // namespace hgrid
