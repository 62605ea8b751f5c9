// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#include "src/node/sources/cloud_news.h"

#include <gtest/gtest.h>

#include "hgrid_proximity/refusal.h"
#include "test/node/support/moments.h"

namespace hgrid {
namespace test {
namespace {

const AgeLimits kLimits{0.1, 0.25, 2.0};

/// Returns a cloud whose newest message has the stamp `stamp` [s] and arrived at the time `received` [s].
LoadedCloud seenAt(double stamp, double received, double lifetime = 1.0) {
  LoadedCloud cloud;
  cloud.lifetime = lifetime;
  cloud.cells = std::make_shared<MapCells>();
  cloud.stamp = s(1000.0 + stamp);
  cloud.received = moment(0.0, 50.0 + received).steady;
  cloud.latency = received - stamp;
  return cloud;
}

Moment at(double time) { return moment(1000.0 + time, 50.0 + time); }

TEST(CloudNews, AgesFromItsStampByTheSteadyClock) {
  CloudNews news(false);
  news.noteAccepted(seenAt(1.0, 1.05));
  EXPECT_NEAR(news.ageOf(at(1.05)), 0.05, 1e-9);
  EXPECT_NEAR(news.ageOf(moment(0.0, 51.25)), 0.25, 1e-9) << "setting the wall clock changes no age";
}

TEST(CloudNews, AgesByASimulatedClockInBothDirections) {
  CloudNews news(true);
  news.noteAccepted(seenAt(1.0, 1.0));
  EXPECT_NEAR(news.ageOf(moment(1001.5, 99.0)), 0.5, 1e-9);
  EXPECT_NEAR(news.ageOf(moment(1000.5, 99.0)), 0.5, 1e-9) << "the clock went back";
}

TEST(CloudNews, IsLostWhenItsCellsAreOlderThanTheirLifetime) {
  CloudNews news(false);
  news.noteAccepted(seenAt(0.0, 0.0, 0.5));
  EXPECT_EQ(news.judge(at(0.1), false, kLimits), Freshness::fresh);
  EXPECT_EQ(news.judge(at(0.2), false, kLimits), Freshness::late);
  EXPECT_EQ(news.judge(at(0.3), false, kLimits), Freshness::stale);
  EXPECT_EQ(news.judge(at(0.51), false, kLimits), Freshness::lost);
  EXPECT_EQ(news.judge(at(0.1), true, kLimits), Freshness::frozen);
}

TEST(CloudNews, LearnsThePeriodOfItsMessages) {
  CloudNews news(false);
  news.noteAccepted(seenAt(0.0, 0.0));
  EXPECT_EQ(news.period(), 0.0) << "one message has no period";
  news.noteAccepted(seenAt(0.2, 0.2));
  EXPECT_NEAR(news.period(), 0.2, 1e-9);
  news.noteAccepted(seenAt(0.3, 0.3));
  EXPECT_NEAR(news.period(), 0.18, 1e-9);
  news.noteAccepted(seenAt(0.3, 0.4));
  EXPECT_NEAR(news.period(), 0.18, 1e-9) << "the same message again, with fewer cells";
  news.noteAccepted(seenAt(5.0, 5.0));
  EXPECT_NEAR(news.period(), 0.18, 1e-9) << "a gap longer than the lifetime is an outage";
}

TEST(CloudNews, ReportsARefusedMessageUntilANewerOneIsAccepted) {
  CloudNews news(false);
  news.noteAccepted(seenAt(0.0, 0.0));
  news.noteRefused("LIMIT too long");
  news.noteAccepted(seenAt(0.0, 0.1));
  EXPECT_EQ(news.refused(), "LIMIT too long") << "only the cells changed; there is no newer message";
  EXPECT_EQ(news.sentence("cloud/eye", Freshness::lost, 2.0),
            "cloud 'cloud/eye': its newest usable message is " + secondsText(2.0) +
                " old; its cells have expired; a later message was refused: LIMIT too long");
  news.noteAccepted(seenAt(0.2, 0.2));
  EXPECT_EQ(news.refused(), "");
}

TEST(CloudNews, LeavesAGapAsFarAsTheSensorSeesFromWhereItCanBe) {
  CloudNews news(false);
  LoadedCloud cloud = seenAt(0.0, 0.0);
  cloud.sensor = {1.0, 2.0, 3.0};
  news.noteAccepted(cloud);
  EXPECT_FALSE(news.gap("cloud/eye", Freshness::lost, 2.0, 0.5).within) << "the sensor's range is not known";
  cloud.range = 4.0;
  news.noteAccepted(cloud);
  const SourceGap gap = news.gap("cloud/eye", Freshness::lost, 2.0, 0.5);
  ASSERT_TRUE(gap.within);
  EXPECT_EQ(gap.within->center, cloud.sensor);
  EXPECT_DOUBLE_EQ(gap.within->radius, 5.0) << "the range of 4 m, plus 1 m that the sensor can have moved";
  EXPECT_EQ(gap.source, "cloud/eye");
  EXPECT_EQ(gap.sentence.find("LOST cloud/eye: "), 0u) << gap.sentence;
}

}  // namespace
}  // namespace test
}  // namespace hgrid
