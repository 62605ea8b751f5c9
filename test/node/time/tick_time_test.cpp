// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#include "src/node/time/tick_time.h"

#include <gtest/gtest.h>

#include "test/node/support/moments.h"

namespace hgrid {
namespace test {
namespace {

TEST(TickTime, IsTheNewestThatAllFramesHaveThatKeepUp) {
  TickTime time(0.1);
  EXPECT_EQ(time.choose({}, s(5)), s(5)) << "no frame moves, so the time is the current time";
  EXPECT_EQ(time.choose({s(6), s(5.95)}, s(6)), s(5.95));
  EXPECT_EQ(time.choose({s(6.2), s(6.0)}, s(6.2)), s(6.2)) << "a frame that lags does not delay the tick";
  EXPECT_EQ(time.choose({s(6.1), s(6.15)}, s(6.2)), s(6.2)) << "the time never runs back";
  time.beginEpoch();
  EXPECT_EQ(time.choose({s(1)}, s(1)), s(1));
}

TEST(TickTime, IsNotSetByFramesThatAreStampedAhead) {
  TickTime time(0.1);
  EXPECT_EQ(time.choose({s(5), s(9)}, s(5)), s(5));
  EXPECT_EQ(time.choose({s(5.08), s(9)}, s(5)), s(5.08)) << "a stamp may be a little ahead of the clock";
  EXPECT_EQ(time.choose({s(9)}, s(6)), s(6.1)) << "the limit also applies if all frames are ahead";
  EXPECT_EQ(time.choose({s(6.2)}, s(6.2)), s(6.2)) << "then the time goes on with the clock";
}

TEST(TickTime, IsThatOfCurrentFramesAlthoughALocalizationStampsItsFrameAhead) {
  TickTime time(0.1);
  EXPECT_EQ(time.choose({s(4.98), s(4.99), s(5.09)}, s(5)), s(4.98));
  EXPECT_EQ(time.keepsUpFrom(), s(4.89));
}

TEST(TickTime, FollowsFramesThatAreAheadIfTheOthersHaveStopped) {
  TickTime time(0.1);
  EXPECT_EQ(time.choose({s(1), s(5.02), s(5.03)}, s(5)), s(5.02));
}

}  // namespace
}  // namespace test
}  // namespace hgrid
