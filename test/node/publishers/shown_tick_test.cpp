// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#include "src/node/publishers/shown_tick.h"

#include <gtest/gtest.h>

#include "test/node/support/settings.h"

namespace hgrid {
namespace test {
namespace {

using std::chrono::milliseconds;
using std::chrono::steady_clock;

const steady_clock::time_point kStart = steady_clock::time_point() + std::chrono::hours(1);

Tick tickMadeAt(milliseconds time, const Params& params = {}) {
  Tick tick;
  tick.settings = settingsOf(params);
  tick.made.steady = kStart + time;
  return tick;
}

TEST(ShownTick, IsTheMeasuredOneWhileItIsNew) {
  const Tick newest = tickMadeAt(milliseconds(900));
  MeasuredTick measured;
  measured.tick = std::make_shared<const Tick>(tickMadeAt(milliseconds(0)));
  measured.distances = std::make_shared<const PairDistances>();
  const ShownTick with_distances = shownTick(newest, &measured, kStart + milliseconds(1000));
  EXPECT_EQ(with_distances.tick, measured.tick.get());
  EXPECT_EQ(with_distances.distances, measured.distances.get());
  for (const MeasuredTick* hanging : std::initializer_list<const MeasuredTick*>{&measured, nullptr}) {
    const ShownTick without = shownTick(newest, hanging, kStart + milliseconds(1001));
    EXPECT_EQ(without.tick, &newest) << "the measurements hang, or nobody needed them";
    EXPECT_EQ(without.distances, nullptr);
  }
}

TEST(ShownTick, IsNoneIfTicksHang) {
  const Tick newest = tickMadeAt(milliseconds(0));
  EXPECT_EQ(shownTick(newest, nullptr, kStart + milliseconds(1000)).tick, &newest);
  EXPECT_EQ(shownTick(newest, nullptr, kStart + milliseconds(1001)).tick, nullptr);
}

TEST(ShownTick, MayBeAsOldAsSlowTicksAre) {
  Params slow;
  slow.heartbeat = 0.1;
  EXPECT_NE(shownTick(tickMadeAt(milliseconds(0), slow), nullptr, kStart + milliseconds(29000)).tick, nullptr);
  slow.follow_data = false;
  EXPECT_EQ(shownTick(tickMadeAt(milliseconds(0), slow), nullptr, kStart + milliseconds(29000)).tick, nullptr)
      << "then only ~rate counts";
}

TEST(MarkerLifetime, IsLongerThanTheTimeUntilTheNextMessage) {
  for (const double rate : {0.1, 1.0, 5.0, 100.0}) {
    Params params;
    params.marker_rate = rate;
    EXPECT_GE(markerLifetime(params).count(), 3.0 / rate);
    EXPECT_GE(markerLifetime(params).count(), 1.0);
    EXPECT_LE(markerLifetime(params).count(), std::max(1.0, 3.0 / rate));
  }
}

}  // namespace
}  // namespace test
}  // namespace hgrid
