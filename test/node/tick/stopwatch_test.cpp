// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#include "src/node/threads/stopwatch.h"

#include <gtest/gtest.h>

namespace hgrid {
namespace test {
namespace {

TEST(Stopwatch, SummarizesTheNewestTicksOnly) {
  Stopwatch stopwatch;
  const auto tick = [&](int milliseconds) { stopwatch.add("tick", std::chrono::milliseconds(milliseconds)); };
  const std::chrono::steady_clock::time_point start(std::chrono::hours(1));
  for (int i = 0; i < 10; ++i) tick(900);
  stopwatch.summarize(start);
  EXPECT_EQ(stopwatch.ticks(), 10u);
  EXPECT_EQ(stopwatch.summaries().at("tick").max, 0.9);
  for (std::size_t i = 0; i < Stopwatch::kTicks; ++i) tick(i < 250 ? 2 : 4);
  tick(4);
  stopwatch.summarize(start + std::chrono::seconds(2));
  EXPECT_EQ(stopwatch.ticks(), Stopwatch::kTicks);
  EXPECT_EQ(stopwatch.summaries().at("tick").last, 0.004);
  EXPECT_EQ(stopwatch.summaries().at("tick").median, 0.004) << "249 ticks took 2 ms, and 251 took 4 ms";
  EXPECT_EQ(stopwatch.summaries().at("tick").max, 0.004) << "the ticks of 900 ms are too old";
}

}  // namespace
}  // namespace test
}  // namespace hgrid
