// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#include "hgrid_proximity/geometry/segment.h"

#include <gtest/gtest.h>

#include "test/support/oracle.h"
#include "test/support/random.h"
#include "test/support/worlds.h"

namespace hgrid {
namespace {

using test::Random;

struct Case {
  Aabb box;
  Segment segment;
};

Case randomCase(unsigned seed) {
  Random random(seed);
  const double size = random.logUniform(1e-3, 1e3), far = random.chance(0.5) ? 0.0 : random.logUniform(1.0, 1e7);
  const double length = size * random.logUniform(1e-3, 1e3);
  Case result;
  Eigen::Vector3d way, middle;
  for (int k = 0; k < 3; ++k) {
    const double base = random.uniform(-far, far);
    result.box.min[k] = float(base);
    result.box.max[k] = std::max(result.box.min[k], float(base + size * random.uniform(0, 1)));
    middle[k] = base + size * random.uniform(-2, 3);
    way[k] = random.chance(0.2) ? 0.0 : length * random.uniform(-1, 1);
  }
  const double part = random.uniform(0, 1);
  result.segment.from = middle - part * way;
  result.segment.to = middle + (1 - part) * way;
  return result;
}

/// Compares the result of meet() with a bisection in extended precision.
void expectRight(const Case& c) {
  const Eigen::Vector3d &a = c.segment.from, &b = c.segment.to;
  const test::Approach approach = test::approachOf(c.box, a, b, c.segment.radius);
  const double slack = test::promisedSlack(a, b, c.segment.radius), length = (b - a).norm();
  const auto meeting = meet(c.segment, c.box);
  if (approach.least <= c.segment.radius) {
    ASSERT_TRUE(meeting) << "meet() misses a box at distance " << double(approach.least);
  }
  if (!meeting) return;
  ASSERT_LE(approach.least, c.segment.radius + slack);
  ASSERT_NEAR(meeting->axis_distance, double(approach.least), slack);
  ASSERT_GE(meeting->along, 0.0);
  ASSERT_LE(meeting->along, length * (1 + 1e-15));
  // At the first touch, the sphere must touch the box. Before, it must not clearly touch the box.
  if (length > 0) {
    ASSERT_LE(test::distanceAt(c.box, a, b, meeting->along / length), c.segment.radius + slack);
  }
  if (approach.least <= c.segment.radius) {
    ASSERT_LE(meeting->along, double(approach.first) + slack);
  }
  for (int k = 0; k < 3; ++k) {
    ASSERT_GE(meeting->point[k], c.box.min[k]);
    ASSERT_LE(meeting->point[k], c.box.max[k]);
  }
  const Aabb point = {meeting->point.cast<float>(), meeting->point.cast<float>()};
  const auto near = test::approachOf(point, a, b, 0.0).least;
  ASSERT_NEAR(double(near), meeting->axis_distance, slack + 2e-7 * meeting->point.norm())
      << "another point of the box is nearer";
}

TEST(Segment, MeetsWhatBisectionFindsAtRadiiBesideTheTrueDistance) {
  int hits = 0, misses = 0;
  for (unsigned seed = 1; seed <= 20000; ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    Case c = randomCase(seed);
    const auto least = double(test::approachOf(c.box, c.segment.from, c.segment.to, 0.0).least);
    const double slack = test::promisedSlack(c.segment.from, c.segment.to, least);
    for (const double radius :
         {0.0, least, least + 2 * slack, least - 3 * slack, least * 1.01, least * 3, least * 0.9}) {
      if (radius < 0) continue;
      c.segment.radius = radius;
      ASSERT_NO_FATAL_FAILURE(expectRight(c)) << "radius " << radius;
      (meet(c.segment, c.box) ? hits : misses)++;
    }
  }
  EXPECT_GT(hits, 10000);
  EXPECT_GT(misses, 10000);
}

TEST(Segment, ReversedMeetsTheSameBoxes) {
  for (unsigned seed = 1; seed <= 20000; ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    Case c = randomCase(seed);
    c.segment.radius = Random(seed).uniform(0, 1);
    const auto there = meet(c.segment, c.box);
    const double slack = test::promisedSlack(c.segment.from, c.segment.to, c.segment.radius);
    const auto least = double(test::approachOf(c.box, c.segment.from, c.segment.to, 0.0).least);
    std::swap(c.segment.from, c.segment.to);
    const auto back = meet(c.segment, c.box);
    if (std::abs(least - c.segment.radius) > slack) {
      ASSERT_EQ(there.has_value(), back.has_value());
    }
    if (there && back) {
      ASSERT_NEAR(there->axis_distance, back->axis_distance, slack);
    }
  }
}

TEST(Segment, WithEqualEndsIsABall) {
  const Aabb box = {{0, 0, 0}, {1, 1, 1}};
  const auto inside = meet({{0.5, 0.5, 0.5}, {0.5, 0.5, 0.5}, 0.0}, box);
  ASSERT_TRUE(inside);
  EXPECT_EQ(inside->along, 0.0);
  EXPECT_EQ(inside->axis_distance, 0.0);
  const auto beside = meet({{4, 5, 0.5}, {4, 5, 0.5}, 5.0}, box);
  ASSERT_TRUE(beside);
  EXPECT_EQ(beside->axis_distance, 5.0);
  EXPECT_EQ(beside->point, Eigen::Vector3d(1, 1, 0.5));
  EXPECT_FALSE(meet({{4, 5, 0.5}, {4, 5, 0.5}, 4.999999}, box));
}

TEST(Segment, StartingInsideTouchesAtOnce) {
  const Aabb box = {{0, 0, 0}, {1, 1, 1}};
  const auto meeting = meet({{0.5, 0.5, 0.5}, {9, 9, 9}, 0.1}, box);
  ASSERT_TRUE(meeting);
  EXPECT_EQ(meeting->along, 0.0);
  EXPECT_EQ(meeting->axis_distance, 0.0);
}

TEST(Segment, SaysWhereItsBallFirstTouches) {
  const Aabb box = {{10, -1, -1}, {11, 1, 1}};
  const auto thin = meet({{0, 0, 0}, {20, 0, 0}, 0.0}, box);
  ASSERT_TRUE(thin);
  EXPECT_NEAR(thin->along, 10.0, 1e-9);
  const auto thick = meet({{0, 0, 0}, {20, 0, 0}, 2.0}, box);
  ASSERT_TRUE(thick);
  EXPECT_NEAR(thick->along, 8.0, 1e-9);
  EXPECT_EQ(thick->axis_distance, 0.0);
  const auto edge = meet({{0, 4, 0}, {20, 4, 0}, 5.0}, box);  // 3 m from an edge of the box: a 3-4-5 triangle
  ASSERT_TRUE(edge);
  EXPECT_NEAR(edge->along, 6.0, 1e-9);
  EXPECT_EQ(edge->axis_distance, 3.0);
}

TEST(Segment, FirstTouchIsAsExactAsTheInputFromFarAway) {
  for (unsigned seed = 1; seed <= 5000; ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    Random random(seed);
    const Aabb box = {{-1, -1, -1}, {1, 1, 1}};
    Segment segment;
    const double far = random.logUniform(2, 1e6);
    segment.from << -far, random.uniform(-0.9, 0.9), random.uniform(-0.9, 0.9);
    segment.to << far * random.uniform(0.5, 2), random.uniform(-0.9, 0.9), random.uniform(-0.9, 0.9);
    const auto approach = test::approachOf(box, segment.from, segment.to, 0.0);
    const auto meeting = meet(segment, box);
    ASSERT_TRUE(meeting);
    ASSERT_NEAR(meeting->along, double(approach.first), test::promisedSlack(segment.from, segment.to, 0.0));
  }
}

TEST(Segment, TheFirstTouchIsThatOfTheMeeting) {
  test::Random random(11);
  int touched = 0;
  for (int i = 0; i < 200000; ++i) {
    const Aabb box = random.chance(0.3)
                         ? test::latticeBox(random, 0.5f)
                         : test::boxAround(test::randomVector(random, -2, 2), test::randomVector(random, 0, 2));
    Segment segment{test::randomVector(random, -4, 4), test::randomVector(random, -4, 4),
                    random.chance(0.7) ? 0.0 : random.uniform(0, 1)};
    for (int k = 0; k < 3; ++k) {
      if (random.chance(0.2)) segment.to[k] = segment.from[k];
      if (random.chance(0.1)) segment.from[k] = box.min[k];
      if (random.chance(0.1)) segment.to[k] = box.max[k];
      if (random.chance(0.02)) segment.to[k] = std::nextafter(segment.from[k], 9.0);
    }
    const auto meeting = meet(segment, box);
    const auto first = FirstTouch(segment)(box);
    ASSERT_EQ(first.has_value(), meeting.has_value()) << "number " << i;
    if (!first) continue;
    ASSERT_NEAR(*first, meeting->along, 1e-9) << "number " << i;
    ++touched;
  }
  EXPECT_GT(touched, 10000);
}

}  // namespace
}  // namespace hgrid
