// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#include "src/node/sources/map_news.h"

#include <gtest/gtest.h>

namespace hgrid {
namespace {

using std::chrono::milliseconds;

/// Returns the moment `ros_ms` [ms] after the start of the ROS clock and `steady_ms` [ms] after that of the steady
/// clock.
Moment after(int ros_ms, int steady_ms) {
  Moment moment;
  moment.ros = Time(milliseconds(1000000 + ros_ms));
  moment.steady = std::chrono::steady_clock::time_point(milliseconds(500000 + steady_ms));
  return moment;
}
Moment after(int ms) { return after(ms, ms); }

LoadedMap mapAt(const Moment& received, int stamped_before_ms, double max_age) {
  LoadedMap map;
  map.params.max_age = max_age;
  map.received = received;
  map.stamp = received.ros - milliseconds(stamped_before_ms);
  return map;
}

TEST(MapNews, AMapWithoutMaxAgeNeverGrowsTooOld) {
  MapNews news(false);
  news.noteAccepted("map/hall", mapAt(after(0), 0, 0.0));
  EXPECT_TRUE(news.gaps(after(1000000)).empty());
}

TEST(MapNews, TheAgeIsThatOfTheStampWhenItCameAndTheTimeSinceThen) {
  MapNews news(false);
  news.noteAccepted("map/hall", mapAt(after(0), 300, 1.0));
  EXPECT_DOUBLE_EQ(news.ageOf("map/hall", after(0)), 0.3);
  EXPECT_DOUBLE_EQ(news.ageOf("map/hall", after(-3600000, 500)), 0.8) << "setting the wall clock changes no age";
  EXPECT_TRUE(news.gaps(after(700)).empty());
  const auto gaps = news.gaps(after(701));
  ASSERT_EQ(gaps.size(), 1u);
  EXPECT_EQ(gaps[0].source, "map/hall");
  EXPECT_EQ(gaps[0].bodies, "map/hall");
  EXPECT_FALSE(gaps[0].within);
  EXPECT_NE(gaps[0].sentence.find("OLD 'map/hall'"), std::string::npos);
  news.noteAccepted("map/hall", mapAt(after(800), 0, 1.0));
  EXPECT_TRUE(news.gaps(after(900)).empty());
}

TEST(MapNews, ASimulatedClockCountsAlone) {
  MapNews news(true);
  news.noteAccepted("map/hall", mapAt(after(0), 0, 1.0));
  EXPECT_TRUE(news.gaps(after(1000, 90000)).empty());
  EXPECT_EQ(news.gaps(after(1001, 10)).size(), 1u);
}

TEST(MapNews, ARefusedMessageCountsUntilTheNextOneIsAccepted) {
  MapNews news(false);
  news.noteRefused("map/hall", "PARSE map 'hall': broken");
  EXPECT_TRUE(news.gaps(after(0)).empty()) << "MissingSources reports maps that are not in the world";
  news.noteAccepted("map/hall", mapAt(after(0), 0, 0.0));
  news.noteAccepted("map/yard", mapAt(after(0), 0, 0.0));
  news.noteRefused("map/hall", "PARSE map 'hall': broken");
  const auto gaps = news.gaps(after(1));
  ASSERT_EQ(gaps.size(), 1u);
  EXPECT_EQ(gaps[0].source, "map/hall");
  EXPECT_NE(gaps[0].sentence.find("PARSE map 'hall': broken"), std::string::npos);
  news.noteAccepted("map/hall", mapAt(after(2), 0, 0.0));
  EXPECT_TRUE(news.gaps(after(3)).empty());
  news.noteRefused("map/hall", "PARSE");
  news.forget("map/hall");
  EXPECT_TRUE(news.gaps(after(4)).empty());
}

}  // namespace
}  // namespace hgrid
