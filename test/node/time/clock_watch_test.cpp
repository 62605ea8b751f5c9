// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#include "src/node/time/clock_watch.h"

#include <gtest/gtest.h>

#include "test/node/support/moments.h"

namespace hgrid {
namespace test {
namespace {

using Event = ClockWatch::Event;

TEST(ClockWatch, ReportsAJumpUntilItIsHandled) {
  ClockWatch watch(false, 10.0, 0.25);
  EXPECT_FALSE(watch.running());
  EXPECT_EQ(watch.look(moment(100, 1)), Event::none);
  EXPECT_TRUE(watch.running());
  EXPECT_EQ(watch.look(moment(90, 2)), Event::jumped_back);
  EXPECT_EQ(watch.look(moment(91, 3)), Event::jumped_back) << "the jump was not handled yet";
  watch.noteHandled();
  EXPECT_EQ(watch.look(moment(92, 4)), Event::none);
  EXPECT_EQ(watch.look(moment(200, 5)), Event::jumped_ahead);
}

TEST(ClockWatch, ReportsAPendingJumpBackEvenIfAJumpAheadFollows) {
  ClockWatch watch(false, 10.0, 0.25);
  watch.look(moment(100, 1));
  watch.look(moment(90, 2));
  EXPECT_EQ(watch.look(moment(200, 3)), Event::jumped_back);
  watch.noteHandled();
  watch.look(moment(300, 4));
  EXPECT_EQ(watch.look(moment(200, 5)), Event::jumped_back) << "also if the jump ahead comes first";
}

TEST(ClockWatch, LetsAWallClockStepBackALittleButNotASimulatedOne) {
  ClockWatch wall(false, 10.0, 0.25), simulated(true, 10.0, 0.25);
  wall.look(moment(100, 1));
  simulated.look(moment(100, 1));
  EXPECT_EQ(wall.look(moment(99.95, 2)), Event::none);
  EXPECT_EQ(simulated.look(moment(99.95, 2)), Event::jumped_back);
}

TEST(ClockWatch, CallsASimulatedClockFrozenThatStandsStillForTooLong) {
  ClockWatch wall(false, 10.0, 0.25), simulated(true, 10.0, 0.25);
  for (ClockWatch* watch : {&wall, &simulated}) {
    watch->look(moment(100, 1));
    watch->look(moment(100, 1.25));
    EXPECT_FALSE(watch->frozen());
    watch->look(moment(100, 1.26));
  }
  EXPECT_TRUE(simulated.frozen());
  EXPECT_FALSE(wall.frozen());
  simulated.look(moment(100.1, 1.3));
  EXPECT_FALSE(simulated.frozen());
}

}  // namespace
}  // namespace test
}  // namespace hgrid
