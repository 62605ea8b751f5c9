// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#include "src/node/time/freshness.h"

#include <gtest/gtest.h>

#include "src/node/time/kept_pose.h"
#include "test/node/support/moments.h"

namespace hgrid {
namespace test {
namespace {

Freshness judged(const KeptPose& pose, Time reading, Time tick_time, double period, const AgeLimits& limits) {
  PoseCircumstances circumstances;
  circumstances.reading = reading;
  circumstances.tick_time = tick_time;
  circumstances.period = period;
  return judgePose(pose, circumstances, limits);
}

TEST(KeptPose, AgesFromTheMomentItWasTrue) {
  const AgeLimits limits{0.1, 0.25, 2.0};
  KeptPose pose;
  EXPECT_FALSE(pose.exists());
  pose.renew(s(50), s(7));
  EXPECT_TRUE(pose.exists());
  EXPECT_EQ(pose.age(s(7.5)), 0.5);
  EXPECT_EQ(pose.age(s(6)), 0.0);
  EXPECT_EQ(judged(pose, s(7.1), s(50), 0.0, limits), Freshness::fresh);
  EXPECT_EQ(judged(pose, s(7.1), s(50.1), 0.0, limits), Freshness::late) << "the pose is older than the tick";
  EXPECT_EQ(judged(pose, s(7.11), s(50), 0.0, limits), Freshness::late);
  EXPECT_EQ(judged(pose, s(7.26), s(50), 0.0, limits), Freshness::stale);
  EXPECT_EQ(judged(pose, s(9.01), s(50), 0.0, limits), Freshness::lost);
}

TEST(KeptPose, OfASlowFrameIsLateAndStaleAfterOneAndAHalfPeriods) {
  const AgeLimits limits{0.1, 0.25, 2.0};
  KeptPose pose;
  pose.renew(s(50), s(0));
  EXPECT_EQ(judged(pose, s(0.14), s(50), 0.1, limits), Freshness::fresh);
  EXPECT_EQ(judged(pose, s(0.16), s(50), 0.1, limits), Freshness::late);
  EXPECT_EQ(judged(pose, s(0.26), s(50), 0.1, limits), Freshness::stale);
  EXPECT_EQ(judged(pose, s(1.49), s(50), 1.0, limits), Freshness::fresh);
  EXPECT_EQ(judged(pose, s(1.51), s(50), 1.0, limits), Freshness::stale);
  EXPECT_EQ(judged(pose, s(2.01), s(50), 1.0, limits), Freshness::lost);
  EXPECT_EQ(judged(pose, s(13.49), s(50), 9.0, limits), Freshness::fresh) << "LOST does not begin before STALE";
  EXPECT_EQ(judged(pose, s(13.51), s(50), 9.0, limits), Freshness::lost);
}

TEST(KeptPose, DoesNotAgeWhileOnlyStaticTransformsGiveIt) {
  KeptPose pose;
  pose.settle(s(50));
  EXPECT_EQ(pose.age(s(1000)), 0.0);
  EXPECT_EQ(judged(pose, s(1000), s(2000), 0.0, {}), Freshness::fresh);
  pose.unsettle(s(1999), s(1000));
  pose.unsettle(s(2000), s(1001));
  EXPECT_EQ(pose.stamp(), s(1999));
  EXPECT_EQ(pose.age(s(1001)), 1.0);
  EXPECT_EQ(judged(pose, s(1001), s(2000), 0.0, {}), Freshness::stale);
}

TEST(KeptPose, KeepsItsAgeWhenTheClockIsSet) {
  KeptPose pose;
  pose.renew(s(50), s(7));
  pose.restamp(s(8), s(2000), false);
  EXPECT_EQ(pose.stamp(), s(1999));
  EXPECT_EQ(pose.age(s(8)), 1.0);
  EXPECT_EQ(judged(pose, s(8), s(2000), 0.0, {}), Freshness::stale);
  pose.restamp(s(8), s(10), true);
  EXPECT_EQ(judged(pose, s(8), s(10), 0.0, {}), Freshness::frozen);
  pose.renew(s(11), s(9));
  EXPECT_EQ(judged(pose, s(9), s(11), 0.0, {}), Freshness::fresh);
}

TEST(Freshness, OfAPoseWithARefusedTransformIsInvalidHoweverYoungItIs) {
  KeptPose pose;
  pose.renew(s(50), s(7));
  PoseCircumstances circumstances{s(7), s(50), 0.0, true, false};
  EXPECT_EQ(judgePose(pose, circumstances, {}), Freshness::invalid);
  circumstances.reading = s(100);
  EXPECT_EQ(judgePose(pose, circumstances, {}), Freshness::invalid) << "an old pose is INVALID as well";
  pose.settle(s(50));
  EXPECT_EQ(judgePose(pose, circumstances, {}), Freshness::invalid) << "a settled pose is INVALID as well";
}

TEST(Freshness, OfAPoseIsAtLeastThatOfTheWorstFrameOfItsChain) {
  KeptPose pose;
  pose.renew(s(50), s(7));
  PoseCircumstances circumstances{s(7.2), s(50), 0.0, false, false};
  circumstances.chain = Freshness::stale;
  EXPECT_EQ(judgePose(pose, circumstances, {}), Freshness::stale);
  circumstances.reading = s(10);
  EXPECT_EQ(judgePose(pose, circumstances, {}), Freshness::lost);
}

TEST(Freshness, OfAnyPoseIsFrozenWhileTheClockStandsStill) {
  KeptPose pose;
  pose.renew(s(50), s(7));
  for (const bool refused : {false, true}) {
    EXPECT_EQ(judgePose(pose, {s(7), s(50), 0.0, refused, true}, {}), Freshness::frozen);
  }
}

TEST(Freshness, OfACloudDependsOnItsAgeItsPeriodAndTheLifetimeOfItsCells) {
  const AgeLimits limits{0.1, 0.25, 1.0};
  EXPECT_EQ(judgeCloud(0.1, 0.0, false, limits), Freshness::fresh);
  EXPECT_EQ(judgeCloud(0.11, 0.0, false, limits), Freshness::late);
  EXPECT_EQ(judgeCloud(0.26, 0.0, false, limits), Freshness::stale);
  EXPECT_EQ(judgeCloud(0.29, 0.2, false, limits), Freshness::fresh) << "less than one and a half periods";
  EXPECT_EQ(judgeCloud(0.31, 0.2, false, limits), Freshness::stale);
  EXPECT_EQ(judgeCloud(1.01, 5.0, false, limits), Freshness::lost) << "LOST does not depend on the period";
  EXPECT_EQ(judgeCloud(0.0, 0.0, true, limits), Freshness::frozen);
}

}  // namespace
}  // namespace test
}  // namespace hgrid
