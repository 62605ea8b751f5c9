// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#include <gtest/gtest.h>

#include "hgrid_proximity/geometry/segment.h"
#include "test/support/oracle.h"
#include "test/support/random.h"

namespace hgrid {
namespace {

using test::Random;

/// Compares meet() for a thin segment (radius 0) with exact arithmetic. meet() must find a box that the segment
/// touches. It must not find a box that the segment misses by more than a rounding error.
void expectSuperset(const Segment& segment, const Aabb& box) {
  const Eigen::Vector3d &a = segment.from, &b = segment.to;
  if (segment.radius == 0.0 && test::exactlyMeets(box, a, b)) {
    ASSERT_TRUE(meet(segment, box)) << a.transpose() << " to " << b.transpose();
  }
  if (meet(segment, box)) {
    const auto least = test::approachOf(box, a, b, 0.0).least;
    ASSERT_LE(least, segment.radius + test::promisedSlack(a, b, segment.radius));
  }
}

TEST(ThinSegment, AlongFacesEdgesAndThroughVerticesIsASupersetOfTheExactAnswer) {
  int met = 0;
  for (unsigned seed = 1; seed <= 30000; ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    Random random(seed);
    // All coordinates lie on a lattice, and some are moved by one unit in the last place. Therefore most cases are
    // contacts.
    const float cell = std::ldexp(1.f, random.between(-6, 6)), offset = random.chance(0.3) ? 1e4f * cell : 0.f;
    const auto somewhere = [&] {
      const int units = random.between(-1, 1);  // a variable, because compilers evaluate arguments in different orders
      return test::stepped(double(offset + cell * float(random.between(-4, 4))), units);
    };
    Aabb box;
    Segment segment;
    for (int k = 0; k < 3; ++k) {
      box.min[k] = offset + cell * float(random.between(-2, 1));
      box.max[k] = box.min[k] + cell * float(random.between(0, 2));
      segment.from[k] = somewhere();
      segment.to[k] = somewhere();
      if (random.chance(0.3)) segment.to[k] = segment.from[k];  // then the segment is parallel to a face
    }
    ASSERT_NO_FATAL_FAILURE(expectSuperset(segment, box));
    met += meet(segment, box).has_value();
  }
  EXPECT_GT(met, 1000);
}

TEST(ThinSegment, WithASignedZeroDirectionMeetsTheSame) {
  const Aabb box = {{-1, 0, 0}, {1, 1, 1}};
  for (const double zero : {0.0, -0.0}) {
    for (const double x : {-1.0, 1.0, 0.0, -0.0}) {
      EXPECT_TRUE(meet({{x, zero, -3}, {x, -zero, 3}, 0.0}, box)) << x;
      EXPECT_TRUE(meet({{x, -zero, 3}, {x, zero, -3}, 0.0}, box)) << x;
      EXPECT_TRUE(meet({{x, zero, zero}, {x, zero, -zero}, 0.0}, box)) << x;
    }
    EXPECT_FALSE(meet({{1.0 + 1e-6, zero, -3}, {1.0 + 1e-6, zero, 3}, 0.0}, box));
  }
}

TEST(ThinSegment, WithDenormalStepsIsAPoint) {
  const double tiny = std::numeric_limits<double>::denorm_min();
  const Aabb box = {{0, 0, 0}, {1, 1, 1}};
  EXPECT_TRUE(meet({{0, 0, 0}, {-tiny, -tiny, -tiny}, 0.0}, box));
  EXPECT_TRUE(meet({{-tiny, 0.5, 0.5}, {tiny, 0.5, 0.5}, 0.0}, box));
  EXPECT_FALSE(meet({{-1, 0.5, 0.5}, {-1 + tiny, 0.5, 0.5}, 0.0}, box));
}

TEST(ThickSegment, AlongAnAxisIsASupersetOfTheExactAnswer) {
  int exact_hits = 0;
  for (unsigned seed = 1; seed <= 30000; ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    Random random(seed);
    Aabb box, axis;  // the axis of the segment as a box of width 0, which has an exact distance
    for (int k = 0; k < 3; ++k) {
      box.min[k] = float(random.between(-12, 12)), box.max[k] = box.min[k] + float(random.between(0, 4));
      axis.min[k] = axis.max[k] = float(random.between(-12, 12));
    }
    const int along = random.below(3);
    axis.max[along] += float(random.between(0, 20));
    Segment segment{axis.min.cast<double>(), axis.max.cast<double>(), double(random.between(0, 13))};
    if (random.chance(0.5)) std::swap(segment.from, segment.to);
    for (const int ulps : {-1, 0, 1}) {
      Segment beside = segment;
      beside.radius = std::max(0.0, test::stepped(segment.radius, ulps));
      const bool exact = test::exactlyWithin(box, axis, beside.radius);
      exact_hits += exact && ulps == 0;
      if (exact) {
        ASSERT_TRUE(meet(beside, box));
      }
      ASSERT_NO_FATAL_FAILURE(expectSuperset(beside, box));
    }
  }
  EXPECT_GT(exact_hits, 4000);
}

}  // namespace
}  // namespace hgrid
