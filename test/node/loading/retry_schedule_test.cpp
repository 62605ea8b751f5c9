// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#include "src/node/loading/retry_schedule.h"

#include <gtest/gtest.h>

namespace hgrid {
namespace test {
namespace {

using std::chrono::milliseconds;

const RetrySchedule::Time kFirstTry{std::chrono::hours(1)};

TEST(RetrySchedule, IsDueAtOnceAtFirst) { EXPECT_TRUE(RetrySchedule().isDue(kFirstTry)); }

TEST(RetrySchedule, PausesDoubleFromHalfASecondToTenSeconds) {
  RetrySchedule schedule;
  RetrySchedule::Time now = kFirstTry;
  for (const int pause : {500, 1000, 2000, 4000, 8000, 10000, 10000}) {
    schedule.noteTry(now);
    EXPECT_FALSE(schedule.isDue(now + milliseconds(pause - 1))) << pause;
    EXPECT_TRUE(schedule.isDue(now + milliseconds(pause))) << pause;
    now += milliseconds(pause);
  }
}

TEST(RetrySchedule, ATryThatComesLateMovesTheNextOne) {
  RetrySchedule schedule;
  schedule.noteTry(kFirstTry);
  schedule.noteTry(kFirstTry + milliseconds(700));
  EXPECT_FALSE(schedule.isDue(kFirstTry + milliseconds(1699)));
  EXPECT_TRUE(schedule.isDue(kFirstTry + milliseconds(1700)));
}

}  // namespace
}  // namespace test
}  // namespace hgrid
