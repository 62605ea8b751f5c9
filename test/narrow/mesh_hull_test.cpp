// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
//
// Tests the hulls with pairs whose distance is known, because they are placed so that it has a known bound.
#include "narrow/mesh_hull.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <limits>
#include <string>
#include <vector>

#include "test/support/random.h"
#include "test/support/shapes.h"
#include "test/support/worlds.h"

namespace hgrid {
namespace {

using namespace test;
using Vector = Eigen::Vector3d;
using Points = std::vector<Vector>;

Vector randomDirection(Random& random) { return randomVector(random, -1.0, 1.0).normalized(); }

/// Returns points of a shape of some size, somewhere: in a box, on a ball, in a plane or on a line. Some occur twice.
Points randomPoints(Random& random) {
  const int kind = random.below(4);
  const Pose pose = randomPose(random, random.chance(0.3) ? random.logUniform(1.0, 1e6) : 1.0);
  const Vector size = random.logUniform(1e-9, 10.0) * randomVector(random, 0.1, 1.0);
  Points points;
  for (int count = random.between(1, 60); count > 0; --count) {
    Vector point = kind == 1 ? randomDirection(random) : randomVector(random, -1.0, 1.0);
    if (kind >= 2) point.z() = 0.0;
    if (kind == 3) point.y() = 0.0;
    points.push_back(pose * Vector(point.cwiseProduct(size)));
    if (random.chance(0.1)) points.push_back(points.front());
  }
  return points;
}

/// Returns a point of the convex hull.
Vector pointInHull(Random& random, const Points& points) {
  Vector sum = Vector::Zero();
  double weights = 0.0;
  for (const Vector& point : points) {
    const double weight = random.chance(0.7) ? 0.0 : random.logUniform(1e-3, 1.0);
    sum += weight * point;
    weights += weight;
  }
  return weights > 0.0 ? Vector(sum / weights) : points[std::size_t(random.below(int(points.size())))];
}

/// Returns an upper bound of the distance of two points, which is computed in extended precision.
double distanceOf(const Vector& on_first, const Vector& on_second, const Pose& first_from_second) {
  const Eigen::Transform<long double, 3, Eigen::Isometry> pose = first_from_second.cast<long double>();
  const auto distance = (pose * on_second.cast<long double>() - on_first.cast<long double>()).norm();
  return stepped(double(distance), 1);
}

double sizeOf(const Points& points) {
  Eigen::AlignedBox3d box;
  for (const Vector& point : points) box.extend(point);
  return box.sizes().norm();
}

/// Returns the largest coordinate of the points along a direction.
double farthestAlong(const Points& points, const Vector& direction) {
  double most = -std::numeric_limits<double>::infinity();
  for (const Vector& point : points) most = std::max(most, direction.dot(point));
  return most;
}

TEST(MeshHull, IsNeverApartIfTwoPointsAreNear) {
  Random random(1);
  for (int i = 0; i < 20000; ++i) {
    SCOPED_TRACE("seed 1, case " + std::to_string(i));
    const Points first = randomPoints(random), second = randomPoints(random);
    const double apart = random.chance(0.3) ? 0.0 : random.logUniform(1e-12, 10.0);
    const Vector on_first = pointInHull(random, first), on_second = pointInHull(random, second);
    Pose pose = randomPose(random, 1.0);
    pose.translation() += on_first + apart * randomDirection(random) - pose * on_second;
    ASSERT_FALSE(MeshHull(first).isApart(MeshHull(second), pose, distanceOf(on_first, on_second, pose)));
  }
}

// The points that touch are corners, which is the most difficult case.
TEST(MeshHull, IsNeverApartIfCornersTouch) {
  Random random(2);
  for (int i = 0; i < 20000; ++i) {
    SCOPED_TRACE("seed 2, case " + std::to_string(i));
    const Points first = randomPoints(random), second = randomPoints(random);
    const Vector direction = randomDirection(random);
    Pose pose = randomPose(random, 1.0);
    const auto farthest = [](const Points& points, const Vector& along) {
      return *std::max_element(points.begin(), points.end(),
                               [&](const Vector& a, const Vector& b) { return along.dot(a) < along.dot(b); });
    };
    const Vector on_first = farthest(first, direction),
                 on_second = farthest(second, pose.linear().transpose() * -direction);
    pose.translation() += on_first - pose * on_second;
    ASSERT_FALSE(MeshHull(first).isApart(MeshHull(second), pose, distanceOf(on_first, on_second, pose)));
  }
}

TEST(MeshHull, IsApartInMostCases) {
  Random random(3);
  int found = 0, count = 0;
  for (int i = 0; i < 3000; ++i) {
    const Points first = randomPoints(random), second = randomPoints(random);
    const Vector direction = randomDirection(random);
    const double size = sizeOf(first) + sizeOf(second), reach = random.uniform(0.0, 0.1) * size;
    Pose pose = randomPose(random, 1.0);
    const Vector back = pose.linear().transpose() * -direction;
    const double apart = random.logUniform(0.01, 0.3) * size + reach;  // along the direction
    pose.translation() +=
        (farthestAlong(first, direction) + farthestAlong(second, back) + apart - pose.translation().dot(direction)) *
        direction;
    // Across the direction, the hulls are about opposite of each other.
    const Vector across = pose * second.front() - first.front();
    pose.translation() -= across - across.dot(direction) * direction;
    found += MeshHull(first).isApart(MeshHull(second), pose, reach) ? 1 : 0;
    ++count;
  }
  EXPECT_GT(found, 0.75 * count);
}

TEST(MeshHull, HasOnlyTheCornersOfTheHull) {
  Random random(4);
  for (int i = 0; i < 200; ++i) {
    SCOPED_TRACE("seed 4, case " + std::to_string(i));
    const Pose pose = randomPose(random, 5.0);
    const Vector size = randomVector(random, 0.05, 2.0);
    Points box, ball;
    for (int k = 0; k < 8; ++k) {
      box.push_back(pose * Vector(k & 1 ? 1 : -1, k & 2 ? 1 : -1, k & 4 ? 1 : -1).cwiseProduct(size));
    }
    for (int k = 0; k < 50; ++k) {
      Vector inside = randomVector(random, -0.99, 0.99);
      if (random.chance(0.5)) inside[random.below(3)] = random.chance(0.5) ? 1.0 : -1.0;  // on a face
      box.push_back(pose * Vector(inside.cwiseProduct(size)));
      ball.push_back(pose * randomDirection(random));
    }
    EXPECT_GE(MeshHull(box).corners(), 8u);
    EXPECT_LE(MeshHull(box).corners(), 14u);  // a point on a face can count as a corner by rounding, one for each face
    EXPECT_EQ(MeshHull(ball).corners(), 50u);
  }
}

TEST(MeshHull, OfManyPointsOrNoneProvesNothing) {
  Random random(5);
  Points many;
  for (std::size_t i = 0; i <= MeshHull::kMostPoints; ++i) many.push_back(randomDirection(random));
  const MeshHull point({Vector::Zero()}), all(many), none({});
  const Pose far(Eigen::Translation3d(0.0, 0.0, 10.0));
  EXPECT_TRUE(point.isApart(point, far, 1.0));
  for (const MeshHull* other : {&all, &none}) {
    EXPECT_EQ(other->corners(), 0u);
    EXPECT_FALSE(point.isApart(*other, far, 1.0));
    EXPECT_FALSE(other->isApart(point, far, 1.0));
  }
  many.pop_back();
  EXPECT_TRUE(point.isApart(MeshHull(many), far, 1.0));
}

TEST(MeshHull, IsNotApartByNumbersThatAreNotFinite) {
  const MeshHull point({Vector::Zero()});
  Pose pose(Eigen::Translation3d(0.0, 0.0, 10.0));
  EXPECT_FALSE(point.isApart(point, pose, std::numeric_limits<double>::infinity()));
  EXPECT_FALSE(point.isApart(point, pose, std::numeric_limits<double>::quiet_NaN()));
  pose.translation().x() = std::numeric_limits<double>::quiet_NaN();
  EXPECT_FALSE(point.isApart(point, pose, 1.0));
}

}  // namespace
}  // namespace hgrid
