// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#include "src/node/process/housekeeping.h"

#include <gtest/gtest.h>

#include <cmath>
#include <stdexcept>
#include <string>

namespace hgrid {
namespace test {
namespace {

using std::chrono::milliseconds;

TEST(ChoreList, DoesEachChoreWhenItsPauseIsOver) {
  Ledger ledger;
  std::string done;
  ChoreList chores({{"a.failed", milliseconds(0), [&](ChoreList::Time) { done += 'a'; }},
                    {"b.failed", milliseconds(1000), [&](ChoreList::Time) { done += 'b'; }}},
                   ledger);
  const ChoreList::Time start{std::chrono::hours(1)};
  for (const int passed : {0, 250, 999, 1000, 1100, 2500}) {
    chores.doDue(start + milliseconds(passed));
    done += ' ';
  }
  EXPECT_EQ(done, "ab a a ab a ab ");
}

TEST(ChoreList, AChoreThatThrowsDoesNotAffectTheOthers) {
  Ledger ledger;
  int done = 0;
  ChoreList chores({{"a.failed", milliseconds(0), [](ChoreList::Time) { throw std::runtime_error("a fault"); }},
                    {"b.failed", milliseconds(0), [&](ChoreList::Time) { ++done; }}},
                   ledger);
  for (int i = 0; i < 3; ++i) chores.doDue(ChoreList::Time{});
  EXPECT_EQ(done, 3);
  EXPECT_EQ(ledger.counters().at("a.failed.INTERNAL"), 3u);
}

TEST(ChorePace, RunsAChoreAtItsRateIfItIsAskedOncePerPeriod) {
  for (const double rate : {0.1, 0.7, 3.0, 4.0, 5.0, 7.5, 100.0}) {
    SCOPED_TRACE(rate);
    ChorePace pace(1.0);
    pace.setRate(rate);
    EXPECT_LE(pace.period(), 0.25);
    for (const double late : {0.0, 0.3, -0.3}) {  // in periods: timers are not exact
      ChorePace inexact(rate);
      const ChorePace::Time start{std::chrono::hours(1)};
      int runs = 0;
      const int periods = static_cast<int>(std::lround(20.0 / rate / inexact.period()));
      for (int i = 0; i < periods; ++i) {
        const double seconds = inexact.period() * (i + (i % 2 == 0 ? 0.0 : late));
        if (inexact.takeDue(start + std::chrono::nanoseconds(std::llround(1e9 * seconds)))) ++runs;
      }
      EXPECT_EQ(runs, 20);
    }
  }
}

}  // namespace
}  // namespace test
}  // namespace hgrid
