// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#include "src/node/tf/frame_pace.h"

#include <gtest/gtest.h>

#include "test/node/support/moments.h"

namespace hgrid {
namespace test {
namespace {

TEST(FramePace, LearnsThePeriodFromTheShorterOfTwoSteps) {
  FramePace pace;
  pace.noteStep(0.1);
  EXPECT_EQ(pace.period(), 0.0) << "one step may be an outage";
  pace.noteStep(0.1);
  EXPECT_DOUBLE_EQ(pace.period(), 0.1);
  pace.noteStep(5.0);
  EXPECT_DOUBLE_EQ(pace.period(), 0.1) << "a single long step is an outage";
  pace.noteStep(5.0);
  EXPECT_NEAR(pace.period(), 0.59, 1e-12) << "two long steps are a slower pace";
  pace.forgetPeriod();
  EXPECT_EQ(pace.period(), 0.0);
}

TEST(FramePace, KnowsByHowMuchTheAgeClockWasAheadOfRosTime) {
  FramePace pace;
  pace.noteReceived(s(12), s(10));
  EXPECT_EQ(pace.received(), s(12));
  EXPECT_EQ(pace.lead(), s(2));
  pace.noteReceived(s(13));
  EXPECT_EQ(pace.received(), s(13));
  EXPECT_EQ(pace.lead(), s(2)) << "a call without ROS time does not change the lead";
}

}  // namespace
}  // namespace test
}  // namespace hgrid
