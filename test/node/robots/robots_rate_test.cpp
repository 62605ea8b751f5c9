// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
//
// The node keeps its rate of ~pairs while three robots move.
#include <cmath>
#include <cstdio>
#include <limits>

#include "robots_cell.h"

namespace hgrid {
namespace test {
namespace {

/// The value that this share (0 .. 1) of the sorted values does not exceed.
double percentile(const std::vector<double>& sorted, double share) {
  const auto rank = static_cast<std::size_t>(std::ceil(share * static_cast<double>(sorted.size())));
  return sorted.at(rank == 0 ? 0 : rank - 1);
}

using RobotsRate = RobotsTest;

TEST_F(RobotsRate, PairsComeAtTheirRateWhileAllMove) {
  constexpr std::chrono::seconds kMeasured(60);
  cell_->puppeteer->move();
  double best = std::numeric_limits<double>::infinity();
  for (int attempt = 1; attempt <= 3 && best > 1.5 * kPeriod; ++attempt) {  // a busy machine may disturb an attempt
    const double before = cell_->proximity->processorTime();
    const std::vector<double> gaps = cell_->pairs->gapsOver(kMeasured);
    const double share = (cell_->proximity->processorTime() - before) / static_cast<double>(kMeasured.count());
    ASSERT_GT(gaps.size(), 1000u);
    std::fprintf(
        stderr,
        "~pairs at 50 Hz, 3 robots moving, attempt %d: %zu gaps [ms]: median %.2f, p99 %.2f, p99.9 %.2f, max %.2f;"
        " the node takes %.1f %% of one processor\n",
        attempt, gaps.size(), 1e3 * percentile(gaps, 0.5), 1e3 * percentile(gaps, 0.99), 1e3 * percentile(gaps, 0.999),
        1e3 * gaps.back(), 100.0 * share);
    best = std::min(best, percentile(gaps, 0.999));
    EXPECT_GE(percentile(gaps, 0.5), 0.9 * kPeriod) << "faster than ~rate";
  }
  EXPECT_LE(best, 1.5 * kPeriod) << "p99.9 of the best attempt [s]";
  EXPECT_TRUE(cell_->proximity->running());
}

}  // namespace
}  // namespace test
}  // namespace hgrid
