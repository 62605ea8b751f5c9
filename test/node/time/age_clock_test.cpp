// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#include "src/node/time/age_clock.h"

#include <gtest/gtest.h>

#include "test/node/support/moments.h"

namespace hgrid {
namespace test {
namespace {

TEST(AgeClock, OfAWallClockIsTheSteadyClock) {
  AgeClock clock(false);
  clock.look(moment(100, 10), false);
  const Time before = clock.read(moment(100, 10));
  EXPECT_EQ(clock.read(moment(3700, 10.5)) - before, s(0.5)) << "the wall clock was set ahead";
  EXPECT_EQ(clock.read(moment(50, 11)) - before, s(1.0)) << "the wall clock was set back";
}

TEST(AgeClock, OfASimulatedClockIsRosTimeHoweverFastThatRuns) {
  AgeClock clock(true);
  clock.look(moment(100, 10), false);
  const Time before = clock.read(moment(100, 10));
  EXPECT_EQ(clock.read(moment(110, 10.1)) - before, s(10.0));
  clock.look(moment(110, 10.1), false);
  EXPECT_EQ(clock.read(moment(110.1, 20)) - before, s(10.1));
}

TEST(AgeClock, GoesOnWhileRosTimeStandsStillOrRunsBack) {
  AgeClock clock(true);
  clock.look(moment(100, 10), false);
  const Time before = clock.read(moment(100, 10));
  clock.look(moment(100, 10.2), false);
  EXPECT_EQ(clock.read(moment(100, 10.2)) - before, s(0.0));
  clock.look(moment(100, 10.3), true);
  EXPECT_EQ(clock.read(moment(100, 10.3)) - before, s(0.3)) << "counted from when ROS time stopped";
  EXPECT_EQ(clock.read(moment(100, 10.5)) - before, s(0.5));
  clock.look(moment(101, 11), false);
  const Time resumed = clock.read(moment(101, 11));
  EXPECT_GE(resumed - before, s(1.0));
  clock.look(moment(5, 11.5), false);
  EXPECT_EQ(clock.read(moment(5, 11.5)) - resumed, s(0.5)) << "a jump back makes no pose younger";
  EXPECT_EQ(clock.read(moment(6, 11.6)) - resumed, s(1.5));
}

}  // namespace
}  // namespace test
}  // namespace hgrid
