// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#include "test/support/oracle.h"

#include <gtest/gtest.h>

#include "test/support/random.h"
#include "test/support/sweep.h"

namespace hgrid {
namespace test {
namespace {

// Tests the oracle itself: compares its long arithmetic with integers, which the processor computes exactly.
TEST(Oracle, ComputesWithWholeNumbersAsTheMachineDoes) {
  Random random(1);
  for (int i = 0; i < 20000; ++i) {
    const auto a = std::int64_t(random.bits() >> 34) - (1 << 29), b = std::int64_t(random.bits() >> 34) - (1 << 29);
    const Exact x(static_cast<double>(a)), y(static_cast<double>(b));
    ASSERT_TRUE(x + y == Exact(static_cast<double>(a + b)));
    ASSERT_TRUE(x - y == Exact(static_cast<double>(a - b)));
    ASSERT_EQ(x < y, a < b);
    ASSERT_TRUE((x + y) * (x - y) == x * x - y * y);
  }
}

TEST(Oracle, LosesNothingBetweenTheSmallestAndTheLargestNumber) {
  const double huge = 0x1p1023, tiny = std::numeric_limits<double>::denorm_min();
  EXPECT_TRUE(Exact(huge) < Exact(huge) + Exact(tiny));
  EXPECT_TRUE(Exact(huge) + Exact(tiny) - Exact(huge) == Exact(tiny));
  EXPECT_TRUE(Exact(0.0) < Exact(tiny) * Exact(tiny));
  EXPECT_EQ((Exact(huge) * Exact(huge) - Exact(huge) * Exact(huge)).sign(), 0);
}

TEST(Oracle, FindsWhereASlantedSegmentPassesACorner) {
  Aabb box;
  box.min.setConstant(0.f);
  box.max.setConstant(1.f);
  EXPECT_TRUE(exactlyMeets(box, {2, 0, 0.5}, {0, 2, 0.5}));  // goes exactly through the edge x = 1, y = 1
  EXPECT_FALSE(exactlyMeets(box, {std::nextafter(2.0, 3.0), 0, 0.5}, {0, 2, 0.5}));
  const Approach approach = approachOf(box, {3, 0, 0.5}, {0, 3, 0.5}, 0.75);
  EXPECT_NEAR(double(approach.least), std::sqrt(0.5), 1e-15);
  EXPECT_NEAR(double(approach.first), std::sqrt(4.5) - 0.25, 1e-15);
}

// sweptOverlaps() is the oracle for worlds that are too large for brute force.
TEST(Oracle, ASweepFindsTheOverlapsThatAllPairsHave) {
  for (unsigned seed = 1; seed <= 110; ++seed) {
    const std::vector<Aabb> boxes = worldOf(static_cast<Family>(seed % kFamilies), seed);
    ASSERT_EQ(sweptOverlaps(boxes), allOverlaps(boxes)) << "seed " << seed;
  }
}

}  // namespace
}  // namespace test
}  // namespace hgrid
