// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#include "src/node/health/start_grace.h"

#include <gtest/gtest.h>

namespace hgrid {
namespace {

const StartGrace::Time kStart{std::chrono::hours(1)};
constexpr std::chrono::milliseconds kLast = StartGrace::kLength - std::chrono::milliseconds(1);

TEST(StartGrace, ExcusesWhatMayStillCome) {
  const StartGrace grace(kStart);
  for (const Code code : {Code::not_ready, Code::unknown_frame, Code::extrapolation}) {
    SCOPED_TRACE(name(code));
    EXPECT_TRUE(grace.excuses(code, kStart));
    EXPECT_TRUE(grace.excuses(code, kStart + kLast));
    EXPECT_FALSE(grace.excuses(code, kStart + StartGrace::kLength));
  }
}

TEST(StartGrace, DoesNotExcuseDataThatIsWrong) {
  for (const Code code : {Code::nonfinite, Code::limit, Code::clock, Code::parse, Code::resource_missing}) {
    EXPECT_FALSE(StartGrace(kStart).excuses(code, kStart)) << name(code);
  }
}

TEST(StartGrace, CountsWhatItExcuses) {
  Ledger ledger;
  for (const StartGrace& grace : {StartGrace(), StartGrace(kStart)}) {
    grace.refuse(ledger, "track/people.refused", Refusal(Code::not_ready, "why"));
  }
  EXPECT_EQ(ledger.counters().at("track/people.refused.NOT_READY"), 2u);
}

}  // namespace
}  // namespace hgrid
