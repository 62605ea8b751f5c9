// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
//
// Distances of shapes of 1 mm to 100 km whose features are brought as near to each other as doubles can express: rims,
// tips, edges that are almost parallel, thin hulls, plates and needles. The environment variable HGRID_TEST_AIMED sets
// the number of pairs of each size.
#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>

#include "test/narrow/aimed_cases.h"
#include "test/narrow/narrow_phase_judge.h"
#include "test/support/distance_oracle.h"

namespace hgrid {
namespace test {
namespace {

class ProvedDistance : public testing::TestWithParam<double> {};

INSTANTIATE_TEST_SUITE_P(Sizes, ProvedDistance, testing::Values(1e-3, 1e-2, 0.1, 1.0, 10.0, 100.0, 1e3, 1e4, 1e5));

TEST_P(ProvedDistance, OfAimedShapesIsNarrowAndContainsTheTruth) {
  const double size = GetParam(), rounding = 1e-12 * size, width = 1e-9 + 1e-12 * size, digits = 1e-17 * size;
  AimedCases aimed(7, size);
  Claim sound("a pair is measured", 0.0), narrow("the bounds are near each other", width);
  Claim not_smaller("the distance is not less than that of the shapes", rounding);
  Claim proved("the lower bound is not greater than the distance of the shapes", digits);
  Claim found("shapes that touch are in contact", 0.0);
  Claim real("shapes that are reported to touch do", rounding);
  Claim straight("the normal is right", 2e-6);
  const int count = countFromEnvironment("HGRID_TEST_AIMED", 20000);
  int judged = 0;
  for (int i = 0; i < count; ++i) {
    const Case placed = aimed.next();
    const Proximity answer = Trial(placed).measure();
    sound.hold(answer.status == Measure::apart || answer.status == Measure::contact ? 0.0 : 1.0, placed);
    const Convex first(placed.first_shape, placed.world_from_first, placed.first_padding),
        second(placed.second_shape, placed.world_from_second, placed.second_padding);
    const CoreDistance core = coreDistance(first, second, 1e-18L * size);
    if (!(core.upper - core.lower <= 1e-15L * size)) continue;  // the oracle has not enough digits either
    ++judged;
    const Real around = first.radius() + second.radius(), truth = core.upper - around;
    if (truth < -digits) found.hold(isContact(Trial(placed).measure(0.0).status) ? 0.0 : 1.0, placed);
    if (answer.status == Measure::contact) {
      real.hold(static_cast<double>(truth), placed);
      continue;
    }
    narrow.hold(answer.distance - answer.lower_bound, placed);
    not_smaller.hold(static_cast<double>(std::max<Real>(truth, 0.0L) - answer.distance), placed);
    proved.hold(static_cast<double>(answer.lower_bound - truth), placed);
    if (core.upper - core.lower > 1e-13L * core.upper || answer.normal.hasNaN()) continue;
    const Vector3r normal = (core.on_second - core.on_first) / core.upper;
    const Real turned = 1e-14L * size / core.upper;  // by the rounding of the relative pose, seen over the distance
    straight.hold(static_cast<double>((normal - answer.normal.cast<Real>()).norm() - turned), placed);
  }
  for (const Claim* claim : {&sound, &narrow, &not_smaller, &proved, &found, &real, &straight}) claim->expectHeld();
  std::printf("shapes of %g m: widest interval %.1e m, %d of %d pairs judged\n", size, narrow.worst(), judged, count);
  const bool has_128_bits = std::numeric_limits<Real>::digits10 > 30;
  EXPECT_GE(judged, has_128_bits ? count - count / 1000 : count * 8 / 10);
}

}  // namespace
}  // namespace test
}  // namespace hgrid
