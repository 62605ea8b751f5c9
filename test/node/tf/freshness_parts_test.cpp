// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
//
// The classes that a pose's time and age come from, each by itself.
#include <gtest/gtest.h>

#include "src/node/tf/age_clock.h"
#include "src/node/tf/frame_claims.h"
#include "src/node/tf/kept_pose.h"
#include "src/node/tf/tick_time.h"

namespace hgrid {
namespace test {
namespace {

Time s(double seconds) { return Time(std::llround(1e9 * seconds)); }

Moment moment(double ros, double steady) {
  Moment result;
  result.ros = s(ros);
  result.steady = std::chrono::steady_clock::time_point(s(steady));
  return result;
}

TEST(AgeClock, OfAWallClockIsTheSteadyClock) {
  AgeClock clock(false);
  clock.look(moment(100, 10), false);
  const Time before = clock.read(moment(100, 10));
  EXPECT_EQ(clock.read(moment(3700, 10.5)) - before, s(0.5)) << "the wall clock was set ahead";
  EXPECT_EQ(clock.read(moment(50, 11)) - before, s(1.0)) << "and back";
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
  EXPECT_EQ(clock.read(moment(100, 10.3)) - before, s(0.3)) << "since it stood still";
  EXPECT_EQ(clock.read(moment(100, 10.5)) - before, s(0.5));
  clock.look(moment(101, 11), false);
  const Time resumed = clock.read(moment(101, 11));
  EXPECT_GE(resumed - before, s(1.0));
  clock.look(moment(5, 11.5), false);
  EXPECT_EQ(clock.read(moment(5, 11.5)) - resumed, s(0.5)) << "a jump back makes nothing younger";
  EXPECT_EQ(clock.read(moment(6, 11.6)) - resumed, s(1.5));
}

TEST(TickTime, IsTheNewestThatAllFramesHaveThatKeepUp) {
  TickTime time(0.1);
  EXPECT_EQ(time.choose({}, s(5)), s(5)) << "nothing moves";
  EXPECT_EQ(time.choose({s(6), s(5.95)}, s(6)), s(5.95));
  EXPECT_EQ(time.choose({s(6.2), s(6.0)}, s(6.2)), s(6.2)) << "a laggard holds nobody back";
  EXPECT_EQ(time.choose({s(6.1), s(6.15)}, s(6.2)), s(6.2)) << "it never runs back";
  time.beginEpoch();
  EXPECT_EQ(time.choose({s(1)}, s(1)), s(1));
}

TEST(TickTime, IsNotSetByFramesThatAreStampedAhead) {
  TickTime time(0.1);
  EXPECT_EQ(time.choose({s(5), s(9)}, s(5)), s(5));
  EXPECT_EQ(time.choose({s(5.08), s(9)}, s(5)), s(5.08)) << "clocks differ a little";
  EXPECT_EQ(time.choose({s(9)}, s(6)), s(6.1)) << "also where all are";
  EXPECT_EQ(time.choose({s(6.2)}, s(6.2)), s(6.2)) << "and they do not hold it there";
}

TEST(KeptPose, AgesFromTheMomentItWasTrue) {
  const AgeLimits limits{0.1, 0.25, 2.0};
  KeptPose pose;
  EXPECT_FALSE(pose.exists());
  pose.renew(s(50), s(7));
  EXPECT_TRUE(pose.exists());
  EXPECT_EQ(pose.age(s(7.5)), 0.5);
  EXPECT_EQ(pose.age(s(6)), 0.0);
  EXPECT_EQ(pose.state(s(7.1), s(50), 0.0, limits), Freshness::fresh);
  EXPECT_EQ(pose.state(s(7.1), s(50.1), 0.0, limits), Freshness::late) << "it is not of the tick";
  EXPECT_EQ(pose.state(s(7.11), s(50), 0.0, limits), Freshness::late);
  EXPECT_EQ(pose.state(s(7.26), s(50), 0.0, limits), Freshness::stale);
  EXPECT_EQ(pose.state(s(9.01), s(50), 0.0, limits), Freshness::lost);
}

TEST(KeptPose, OfASlowFrameIsLateAndStaleAfterOneAndAHalfPeriods) {
  const AgeLimits limits{0.1, 0.25, 2.0};
  KeptPose pose;
  pose.renew(s(50), s(0));
  EXPECT_EQ(pose.state(s(0.14), s(50), 0.1, limits), Freshness::fresh);
  EXPECT_EQ(pose.state(s(0.16), s(50), 0.1, limits), Freshness::late);
  EXPECT_EQ(pose.state(s(0.26), s(50), 0.1, limits), Freshness::stale);
  EXPECT_EQ(pose.state(s(1.49), s(50), 1.0, limits), Freshness::fresh);
  EXPECT_EQ(pose.state(s(1.51), s(50), 1.0, limits), Freshness::stale);
  EXPECT_EQ(pose.state(s(2.01), s(50), 9.0, limits), Freshness::lost) << "whatever the period";
}

TEST(KeptPose, DoesNotAgeWhileOnlyStaticTransformsGiveIt) {
  KeptPose pose;
  pose.settle(s(50));
  EXPECT_EQ(pose.age(s(1000)), 0.0);
  EXPECT_EQ(pose.state(s(1000), s(2000), 0.0, {}), Freshness::fresh);
  pose.unsettle(s(1999), s(1000));
  pose.unsettle(s(2000), s(1001));
  EXPECT_EQ(pose.stamp(), s(1999));
  EXPECT_EQ(pose.age(s(1001)), 1.0);
  EXPECT_EQ(pose.state(s(1001), s(2000), 0.0, {}), Freshness::stale);
}

TEST(KeptPose, KeepsItsAgeWhenTheClockIsSet) {
  KeptPose pose;
  pose.renew(s(50), s(7));
  pose.restamp(s(8), s(2000), false);
  EXPECT_EQ(pose.stamp(), s(1999));
  EXPECT_EQ(pose.age(s(8)), 1.0);
  EXPECT_EQ(pose.state(s(8), s(2000), 0.0, {}), Freshness::stale);
  pose.restamp(s(8), s(10), true);
  EXPECT_EQ(pose.state(s(8), s(10), 0.0, {}), Freshness::frozen);
  pose.renew(s(11), s(9));
  EXPECT_EQ(pose.state(s(9), s(11), 0.0, {}), Freshness::fresh);
}

TEST(FrameClaims, KeepARivalsFirstTransformUntilTheHolderHasCaughtUp) {
  FrameClaims claims;
  EXPECT_FALSE(claims.take(3, s(9)));
  claims.keep(3, {{"/b", "base"}, s(5), {}});
  claims.keep(3, {{"/b", "base"}, s(6), {}});
  EXPECT_FALSE(claims.take(3, s(4.9)));
  const auto rival = claims.take(3, s(5));
  ASSERT_TRUE(rival);
  EXPECT_EQ(rival->stamp, s(5));
  EXPECT_FALSE(claims.take(3, s(9)));
}

TEST(FrameClaims, NoticeThatTwoTakeTurns) {
  FrameClaims claims;
  const FrameClaim a{"/a", "base"}, b{"/b", "base"}, elsewhere{"/a", "map"};
  EXPECT_FALSE(claims.change(1, a, b, s(1))) << "it may be handed over";
  EXPECT_TRUE(claims.change(1, b, a, s(2)));
  EXPECT_FALSE(claims.change(1, a, elsewhere, s(2.1)));
  EXPECT_FALSE(claims.change(1, elsewhere, a, s(9))) << "after a while it is another hand-over";
  EXPECT_FALSE(claims.change(2, b, a, s(9))) << "another frame";
}

TEST(FrameClaims, NameBothSidesForThreeSeconds) {
  FrameClaims claims;
  EXPECT_FALSE(claims.isContested(1, s(10)));
  claims.contradict(1, "b", {"/z", "base"}, {"/a", "island"}, s(10));
  EXPECT_TRUE(claims.isContested(1, s(12.9)));
  EXPECT_FALSE(claims.isContested(1, s(13)));
  const std::string sentence = claims.sentence(1);
  EXPECT_EQ(sentence,
            "frame 'b' comes from /a with parent 'island' and from /z with parent 'base'; only one publisher may place "
            "a frame");
  claims.contradict(1, "b", {"/a", "island"}, {"/z", "base"}, s(11));
  EXPECT_EQ(claims.sentence(1), sentence) << "whoever holds it";
  claims.contradict(0, "a", {"/a", "base"}, {"/z", "base"}, s(12));
  ASSERT_EQ(claims.sentences(s(13)).size(), 2u);
  EXPECT_NE(claims.sentences(s(13))[0].find("'base' at different poses"), std::string::npos);
  EXPECT_EQ(claims.sentences(s(14)).size(), 1u);
  EXPECT_TRUE(claims.sentences(s(15)).empty());
}

}  // namespace
}  // namespace test
}  // namespace hgrid
