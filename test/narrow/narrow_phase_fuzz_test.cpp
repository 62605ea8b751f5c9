// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
//
// Measures strange shapes in strange poses: nothing aborts, nothing throws, and every answer is consistent.
// The environment variable HGRID_TEST_FUZZ multiplies the number of cases.
#include <gtest/gtest.h>

#include "test/narrow/narrow_phase_judge.h"
#include "test/narrow/strange_cases.h"

namespace hgrid {
namespace test {
namespace {

int cases(int by_default) { return by_default * countFromEnvironment("HGRID_TEST_FUZZ", 1); }

TEST(NarrowPhaseFuzz, EveryAnswerIsConsistent) {
  Random random(11);
  int failed = 0;
  for (int i = 0; i < cases(30000); ++i) {
    SCOPED_TRACE("case " + std::to_string(i));
    const Case strange = strangeCase(random);
    ASSERT_NO_THROW({
      const Trial trial(strange);
      const double up_to = random.chance(0.7) ? std::numeric_limits<double>::infinity() : random.logUniform(1e-9, 10.0);
      const Proximity answer = trial.measure(up_to);
      ASSERT_EQ(unsound(answer, up_to), "") << strange.text();
      ASSERT_TRUE(isSameInOtherOrder(strange, answer, trial.measureSwapped(up_to))) << strange.text();
      failed += answer.status == Measure::failed;
    });
  }
  EXPECT_EQ(failed, 0) << "finite shapes at finite poses must not fail";
}

// Rounding errors of double grow with the size of the shapes. So the allowed error is 1e-6 m plus 1e-8 of the sizes.
TEST(NarrowPhaseFuzz, MeasuresStrangeShapesAccurately) {
  Random random(12);
  Claim distance("the distance of separate shapes is right", 1.0);
  Claim contact("shapes that are reported to touch are not apart", 1.0);
  Claim missed("contact is not missed", 0.0);
  for (int i = 0; i < cases(10000); ++i) {
    const Case strange = strangeCase(random);
    const Proximity answer = Trial(strange).measure();
    const SolidOracle first = strange.first(), second = strange.second();
    const Interval truth = distanceOf(first, second).interval;
    const double allowed = 1e-6 + 1e-8 * (strange.first_shape.reach() + strange.second_shape.reach());
    if (answer.status == Measure::apart) {
      distance.hold(truth.errorOf(answer.distance) / allowed, strange);
      if (truth.lower == 0.0) missed.hold(!overlapByMore(first, second, 10 * allowed), strange);
    } else if (answer.status != Measure::containment_unknown) {
      contact.hold(truth.lower / allowed, strange);
    }
  }
  distance.expectHeld();
  contact.expectHeld();
  missed.expectHeld();
}

TEST(NarrowPhaseFuzz, APoseThatIsNotFiniteFails) {
  Random random(13);
  const double infinity = std::numeric_limits<double>::infinity();
  const double strangers[] = {std::numeric_limits<double>::quiet_NaN(), infinity, -infinity};
  for (int i = 0; i < cases(2000); ++i) {
    Case broken = strangeCase(random);
    Pose& pose = random.chance(0.5) ? broken.world_from_first : broken.world_from_second;
    const double stranger = strangers[random.below(3)];
    if (random.chance(0.5)) {
      pose.translation()[random.below(3)] = stranger;
    } else {
      pose.linear()(random.below(3), random.below(3)) = stranger;
    }
    const Trial trial(broken);
    for (const Proximity& answer : {trial.measure(), trial.measureSwapped(), trial.measure(0.1)}) {
      ASSERT_EQ(answer.status, Measure::failed) << broken.text();
      ASSERT_EQ(unsound(answer), "") << broken.text();
    }
  }
}

}  // namespace
}  // namespace test
}  // namespace hgrid
