// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#include "src/node/loop/tick_pace.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <vector>

#include "test/support/random.h"

namespace hgrid {
namespace test {
namespace {

using Reading = TickPace::Time;

Reading at(double seconds) {
  return Reading(std::chrono::duration_cast<TickPace::Duration>(std::chrono::duration<double>(seconds)));
}
double secondsOf(Reading reading) { return std::chrono::duration<double>(reading.time_since_epoch()).count(); }

/// Makes ticks exactly when they are due. @returns when the ticks began [s]
std::vector<double> ticksFor(TickPace pace, const std::vector<double>& reasons, double end) {
  std::vector<double> ticks;
  for (const double reason : reasons) {
    while (secondsOf(pace.due()) <= reason) {
      ticks.push_back(secondsOf(pace.due()));
      pace.noteTick(pace.due());
    }
    pace.noteReason(at(reason));
  }
  while (secondsOf(pace.due()) <= end) {
    ticks.push_back(secondsOf(pace.due()));
    pace.noteTick(pace.due());
  }
  return ticks;
}

TEST(TickPace, ATickBeginsAtItsReasonButNotSoonerThanAPeriodAfterTheLastOne) {
  TickPace pace(50.0, 10.0, true, at(1.0));
  pace.noteTick(at(1.0));
  EXPECT_NEAR(secondsOf(pace.due()), 1.1, 1e-6) << "without a reason, the heartbeat decides";
  pace.noteReason(at(1.05));
  pace.noteReason(at(1.06));
  EXPECT_NEAR(secondsOf(pace.due()), 1.05, 1e-6) << "the first reason counts";
  pace.noteTick(at(1.05));
  pace.noteReason(at(1.051));
  EXPECT_NEAR(secondsOf(pace.due()), 1.06, 1e-6) << "half a period after a tick that came late";
  pace.noteTick(at(1.06));
  pace.noteReason(at(1.061));
  EXPECT_NEAR(secondsOf(pace.due()), 1.08, 1e-6) << "a period after a tick that came as early as it could";
}

TEST(TickPace, AChangeWaitsForTheTickOfTheNextDataOrForHalfAPeriodLonger) {
  TickPace pace(50.0, 10.0, true, at(1.0));
  pace.noteTick(at(1.0));
  pace.noteChange(at(1.005));
  EXPECT_NEAR(secondsOf(pace.due()), 1.03, 1e-6);
  pace.noteReason(at(1.021));
  EXPECT_NEAR(secondsOf(pace.due()), 1.021, 1e-6) << "the data comes first";
  pace.noteTick(at(1.021));
  EXPECT_NEAR(secondsOf(pace.due()), 1.121, 1e-6) << "the tick contains the change";
  pace.noteChange(at(1.09));
  EXPECT_NEAR(secondsOf(pace.due()), 1.09, 1e-6) << "no tick has begun for a while";
}

TEST(TickPace, ChangesDoNotDelayTheTicksOfDataOfTheSameRate) {
  for (unsigned seed = 1; seed <= 20; ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    Random random(seed);
    TickPace pace(100.0, 20.0, true, at(0.99));
    pace.noteTick(at(0.99));
    for (int i = 0; i < 500; ++i) {
      const double arrival = 1.0 + 0.01 * i;
      if (random.chance(0.2)) pace.noteChange(at(arrival - random.uniform(0.0, 0.009)));
      pace.noteReason(at(arrival));
      EXPECT_NEAR(secondsOf(pace.due()), arrival, 1e-6);
      pace.noteTick(pace.due());
    }
  }
}

TEST(TickPace, TicksThatDoNotFollowTheDataComeAtRegularTimes) {
  TickPace pace(50.0, 10.0, false, at(1.0));
  for (int tick = 0; tick < 5; ++tick) {
    pace.noteReason(at(1.001));
    EXPECT_NEAR(secondsOf(pace.due()), 1.0 + 0.02 * tick, 1e-6);
    pace.noteTick(pace.due() + std::chrono::milliseconds(3));
  }
  pace.noteTick(at(2.0));
  EXPECT_NEAR(secondsOf(pace.due()), 2.02, 1e-6) << "ticks that were missed are not made up for";
}

TEST(TickPace, NoSecondHasMoreThanOneTickAboveTheRateAndNoPauseIsLongerThanTheHeartbeat) {
  for (unsigned seed = 1; seed <= 50; ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    Random random(seed);
    const double rate = 10.0 + random.below(90), heartbeat = 1.0 + random.below(9);
    std::vector<double> reasons;
    const double most_pause = 0.001 * (1 + random.below(300));
    for (double time = 1.0; time < 6.0; time += random.uniform(0.0, most_pause)) reasons.push_back(time);
    const std::vector<double> ticks = ticksFor(TickPace(rate, heartbeat, true, at(1.0)), reasons, 6.0);
    ASSERT_GE(ticks.size(), 4u);
    for (std::size_t i = 0; i < ticks.size(); ++i) {
      const auto most = static_cast<std::size_t>(rate) + 1;
      const std::size_t later = std::min(i + most, ticks.size() - 1), before = i == 0 ? 0 : i - 1;
      EXPECT_TRUE(later < i + most || ticks[later] - ticks[i] >= 1.0 - 1e-6);
      EXPECT_LE(ticks[i] - ticks[before], 1.0 / heartbeat + 1e-6);
    }
  }
}

TEST(TickPace, DataOfTheSameRateWithJitterNeverWaitsForLongerThanTheJitter) {
  for (unsigned seed = 1; seed <= 20; ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    Random random(seed);
    constexpr double kJitter = 0.004;  // [s]
    TickPace pace(50.0, 10.0, true, at(0.97));
    pace.noteTick(at(0.97));
    for (int i = 0; i < 500; ++i) {
      const double arrival = 1.0 + 0.02 * i + random.uniform(0.0, kJitter);
      pace.noteReason(at(arrival));
      EXPECT_GE(secondsOf(pace.due()), arrival - 1e-6);
      EXPECT_LE(secondsOf(pace.due()), arrival + kJitter + 1e-6);
      pace.noteTick(pace.due());
    }
  }
}

}  // namespace
}  // namespace test
}  // namespace hgrid
