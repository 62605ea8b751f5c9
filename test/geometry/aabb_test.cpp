// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#include "hgrid_proximity/geometry/aabb.h"

#include <gtest/gtest.h>

#include "test/support/oracle.h"
#include "test/support/random.h"

namespace hgrid {
namespace {

using test::Exact;
using test::Random;
using test::stepped;

constexpr float kTiny = std::numeric_limits<float>::denorm_min();
constexpr float kHuge = std::numeric_limits<float>::max();

Aabb boxAt(float x, float y, float z, float side = 0.f) {
  Aabb box;
  box.min << x, y, z;
  box.max = box.min.array() + side;
  return box;
}

/// Returns two boxes. On up to three axes they are about `size` apart. Their coordinates are at most about `far`.
std::pair<Aabb, Aabb> randomBoxes(Random& random, double size, double far) {
  Aabb a, b;
  for (int k = 0; k < 3; ++k) {
    const auto base = float(random.uniform(-far, far));
    const float ends[] = {base, float(base + size * random.uniform(0, 1)), float(base + size * random.uniform(0.5, 2)),
                          float(base + size * random.uniform(2, 3))};
    const bool apart = random.chance(0.7), swapped = random.chance(0.5);
    a.min[k] = ends[0], a.max[k] = ends[1];
    b.min[k] = apart ? std::max(ends[1], ends[2]) : ends[0], b.max[k] = std::max(b.min[k], ends[3]);
    if (swapped) {
      std::swap(a.min[k], b.min[k]);
      std::swap(a.max[k], b.max[k]);
    }
  }
  return {a, b};
}

TEST(Aabb, WithinDistanceIsExactAtAndBesideTheTrueDistance) {
  for (unsigned seed = 1; seed <= 20000; ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    Random random(seed);
    const double size = random.logUniform(1e-38, 1e38),
                 far = random.chance(0.5) ? size : random.logUniform(1e-38, 1e38);
    const auto [a, b] = randomBoxes(random, size, far);
    const double near = distance(a, b);
    for (int ulps = -3; ulps <= 3; ++ulps) {
      const double margin = std::max(0.0, stepped(near, ulps));
      const bool expected = test::exactlyWithin(a, b, margin);
      ASSERT_EQ(withinDistance(a, b, margin), expected) << "margin " << margin << " at " << ulps << " ulps";
      ASSERT_EQ(withinDistance(b, a, margin), expected) << "the result depends on the order of the two boxes";
    }
  }
}

TEST(Aabb, DistanceIsRightToAFewUnitsInTheLastPlace) {
  for (unsigned seed = 1; seed <= 20000; ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    Random random(seed);
    const double size = random.logUniform(1e-38, 1e38);
    const auto [a, b] = randomBoxes(random, size, random.logUniform(1e-38, 1e38));
    const Exact low(stepped(distance(a, b), -4)), high(stepped(distance(a, b), 4)),
        squared = test::exactSquaredDistance(a, b);
    ASSERT_TRUE(squared <= high * high);
    ASSERT_TRUE(low.sign() < 0 || low * low <= squared);
  }
}

TEST(Aabb, MarginsEqualToTheDistanceCountAndTheNextSmallerDoesNot) {
  const int quadruples[][4] = {{3, 4, 0, 5}, {1, 2, 2, 3}, {2, 3, 6, 7}, {1, 4, 8, 9}, {5, 12, 0, 13}, {6, 6, 7, 11}};
  for (const auto& q : quadruples) {
    for (const float unit : {1.f, 0x1p-20f, 0x1p20f, 0x1p-126f, 0x1p-149f, 0x1p120f}) {
      for (int sides = 0; sides < 8; ++sides) {
        Aabb a = boxAt(0, 0, 0), b;
        for (int k = 0; k < 3; ++k) b.min[k] = b.max[k] = float(q[k]) * unit * (sides >> k & 1 ? -1.f : 1.f);
        const double margin = double(q[3]) * unit;
        EXPECT_TRUE(withinDistance(a, b, margin)) << unit;
        EXPECT_FALSE(withinDistance(a, b, stepped(margin, -1))) << unit;
        EXPECT_EQ(distance(a, b), margin);
      }
    }
  }
}

TEST(Aabb, ZeroMarginMeansThatTheFacesTouch) {
  for (const float face : {1.f, -1.f, 1e6f, kTiny, -kTiny, 1e-30f, 0.f, -0.f, 1e30f}) {
    const Aabb left = {{-kHuge, 0, 0}, {face, 1, 1}}, touching = {{face, 1, 1}, {kHuge, 2, 2}};
    const Aabb apart = {{stepped(face, 1), 1, 1}, {kHuge, 2, 2}};
    EXPECT_TRUE(overlap(left, touching) && overlap(touching, left)) << face;
    EXPECT_TRUE(withinDistance(left, touching, 0.0)) << face;
    EXPECT_FALSE(overlap(left, apart) || overlap(apart, left)) << face;
    EXPECT_FALSE(withinDistance(left, apart, 0.0)) << face;
  }
}

TEST(Aabb, WithinDistanceKnowsTheSmallestAndTheLargestMargins) {
  const Aabb a = boxAt(0, 0, 0), b = boxAt(kTiny, 0, 0);
  EXPECT_TRUE(withinDistance(a, b, kTiny));
  EXPECT_FALSE(withinDistance(a, b, stepped(double(kTiny), -1)));
  EXPECT_FALSE(withinDistance(a, b, std::numeric_limits<double>::denorm_min()));
  EXPECT_TRUE(withinDistance(a, a, std::numeric_limits<double>::denorm_min()));
  const Aabb far = boxAt(kHuge, -kHuge, kHuge);
  EXPECT_TRUE(withinDistance(boxAt(-kHuge, kHuge, -kHuge), far, 1.2e39));
  EXPECT_FALSE(withinDistance(boxAt(-kHuge, kHuge, -kHuge), far, 1.1e39));
  EXPECT_TRUE(withinDistance(a, far, 1e200)) << "the square of the margin overflows a double";
  EXPECT_TRUE(withinDistance(a, a, std::numeric_limits<double>::infinity()));
}

TEST(Aabb, OverlapIsTheSameInBothOrdersAndOnEveryAxis) {
  Random random(7);
  for (int i = 0; i < 20000; ++i) {
    const auto [a, b] = randomBoxes(random, 1.0, 1.0);
    ASSERT_EQ(overlap(a, b), test::oracleOverlap(a, b));
    ASSERT_EQ(overlap(b, a), test::oracleOverlap(a, b));
  }
}

TEST(Aabb, RoundsDownAndUpToTheNeighboringFloats) {
  Random random(3);
  for (int i = 0; i < 100000; ++i) {
    const double value = random.logUniform(1e-46, 3e38) * (random.chance(0.5) ? 1 : -1);
    const float low = roundedDown(value), high = roundedUp(value);
    ASSERT_LE(low, value);
    ASSERT_GT(stepped(low, 1), value);
    ASSERT_GE(high, value);
    ASSERT_LT(stepped(high, -1), value);
  }
  for (const float exact : {0.f, 1.f, -1.f, kTiny, -kTiny, kHuge, -kHuge, 0.1f}) {
    EXPECT_EQ(roundedDown(exact), exact);
    EXPECT_EQ(roundedUp(exact), exact);
  }
  EXPECT_EQ(roundedDown(-1e39), -std::numeric_limits<float>::infinity());
  EXPECT_EQ(roundedUp(1e39), std::numeric_limits<float>::infinity());
  EXPECT_EQ(roundedUp(1e-300), kTiny);
  EXPECT_EQ(roundedDown(-1e-300), -kTiny);
}

TEST(Aabb, GrownContainsEveryPointWithinTheGrowth) {
  for (unsigned seed = 1; seed <= 50000; ++seed) {
    Random random(seed);
    const auto [box, other] = randomBoxes(random, random.logUniform(1e-10, 1e10), random.logUniform(1e-10, 1e10));
    const double by = random.chance(0.1) ? 0.0 : random.logUniform(1e-20, 1e12);
    const Aabb large = grown(box, by);
    for (int k = 0; k < 3; ++k) {
      ASSERT_TRUE(Exact(large.min[k]) <= Exact(box.min[k]) - Exact(by)) << "seed " << seed;
      ASSERT_TRUE(Exact(box.max[k]) + Exact(by) <= Exact(large.max[k])) << "seed " << seed;
      // The box must not grow much more than `by`, because boxes that are too large select too many candidates.
      ASSERT_GE(large.min[k], box.min[k] - by - 3e-7 * (std::fabs(box.min[k]) + by) - 1e-44) << "seed " << seed;
      ASSERT_LE(large.max[k], box.max[k] + by + 3e-7 * (std::fabs(box.max[k]) + by) + 1e-44) << "seed " << seed;
    }
    (void)other;
  }
}

TEST(Aabb, BoxesWithinAMarginOverlapWhenEachIsGrownByHalf) {
  for (unsigned seed = 1; seed <= 20000; ++seed) {
    Random random(seed);
    const auto [a, b] = randomBoxes(random, random.logUniform(1e-6, 1e6), random.logUniform(1e-6, 1e6));
    const double half = distance(a, b) * 0.5;
    if (test::exactlyWithin(a, b, half + half)) {
      ASSERT_TRUE(overlap(grown(a, half), grown(b, half))) << "seed " << seed;
    }
  }
}

TEST(Aabb, NearestPointsLieInTheirBoxesAtTheDistanceOfTheBoxes) {
  Random random(9);
  for (int i = 0; i < 2000; ++i) {
    const auto [a, b] = randomBoxes(random, random.logUniform(1e-3, 1e3), 10.0);
    const Eigen::AlignedBox3d first = inDouble(a), second = inDouble(b);
    const BoxPoints points = nearestPoints(first, second), swapped = nearestPoints(second, first);
    ASSERT_TRUE(first.contains(points.on_first));
    ASSERT_TRUE(second.contains(points.on_second));
    ASSERT_DOUBLE_EQ((points.on_first - points.on_second).norm(), distance(a, b));
    ASSERT_EQ(points.on_first, swapped.on_second);
    ASSERT_EQ(points.on_second, swapped.on_first);
    ASSERT_EQ(nearestPoint(second, points.on_first), points.on_second);
    for (int axis = 0; axis < 3; ++axis) {
      const double low = std::max(a.min[axis], b.min[axis]), high = std::min(a.max[axis], b.max[axis]);
      if (low <= high) {
        ASSERT_EQ(points.on_first[axis], 0.5 * (low + high))
            << "on this axis the point must be in the middle of the overlap";
      }
    }
  }
}

TEST(Aabb, PenetrationDepthIsTheLengthOfTheShortestMoveThatSeparates) {
  Random random(10);
  int deep = 0;
  for (int i = 0; i < 2000; ++i) {
    const auto [a, b] = randomBoxes(random, 1.0, 10.0);
    const Eigen::AlignedBox3d first = inDouble(a), second = inDouble(b);
    const double depth = penetrationDepth(first, second);
    ASSERT_EQ(depth, penetrationDepth(second, first));
    const auto separates = [&](const Eigen::Vector3d& move) {
      return !first.intersects(Eigen::AlignedBox3d(second).translate(move));
    };
    bool some_axis = false;
    for (int axis = 0; axis < 3; ++axis) {
      for (const double sign : {-1.0, 1.0}) {
        some_axis = some_axis || separates(sign * (depth + 1e-6) * Eigen::Vector3d::Unit(axis));
      }
    }
    if (!first.intersects(second)) {
      ASSERT_EQ(depth, 0.0);
      continue;
    }
    ASSERT_TRUE(some_axis) << depth;
    if (depth < 1e-5) continue;
    for (int k = 0; k < 50; ++k) {
      const Eigen::Vector3d direction(random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-1, 1));
      ASSERT_FALSE(separates((depth - 1e-6) * direction.normalized())) << depth;
    }
    deep += depth > 0.01;
  }
  EXPECT_GT(deep, 20);
}

TEST(Aabb, IsValidOnlyIfFiniteAndOrderedOnEveryAxis) {
  EXPECT_TRUE(isValid(Aabb{}));
  EXPECT_TRUE(isValid({{-0.f, 0, 0}, {0.f, 0, 0}}));
  for (int k = 0; k < 3; ++k) {
    Aabb box = boxAt(0, 0, 0, 1);
    box.min[k] = 2;
    EXPECT_FALSE(isValid(box));
    for (const float bad : {std::numeric_limits<float>::quiet_NaN(), std::numeric_limits<float>::infinity(),
                            -std::numeric_limits<float>::infinity()}) {
      box = boxAt(0, 0, 0, 1);
      box.min[k] = bad;
      EXPECT_FALSE(isValid(box));
      box = boxAt(0, 0, 0, 1);
      box.max[k] = bad;
      EXPECT_FALSE(isValid(box));
    }
  }
}

}  // namespace
}  // namespace hgrid
