// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
//
// Tests ~pairs while three robots move. `scripts/bench --node` measures how long the ticks take.
#include "robots_cell.h"

namespace hgrid {
namespace test {
namespace {

using RobotsRate = RobotsTest;

/// Claim: messages arrive in order, each once, and the ticks keep their rate by the stamps of their data. Some messages
/// may be missing: a subscriber that is slow misses ticks.
TEST_F(RobotsRate, EachTickIsPublishedAtMostOnceAndInOrderWhileAllMove) {
  cell_->puppeteer->move();
  const std::vector<hgrid_proximity::PairsConstPtr> messages = cell_->pairs->next(200, std::chrono::seconds(60));
  ASSERT_EQ(messages.size(), 200u);
  for (std::size_t i = 1; i < messages.size(); ++i) {
    SCOPED_TRACE("message " + std::to_string(i));
    EXPECT_GT(messages[i]->world.sequence, messages[i - 1]->world.sequence);
    EXPECT_GE(messages[i]->world.stamp, messages[i - 1]->world.stamp);
  }
  const auto ticks = static_cast<double>(messages.back()->world.sequence - messages.front()->world.sequence);
  const double period = (messages.back()->world.stamp - messages.front()->world.stamp).toSec() / ticks;
  EXPECT_GE(period, 0.9 * kPeriod) << "[s] by the stamps: the ticks come faster than ~rate";
  // A busy machine makes ticks slower. Ticks that wait for ~heartbeat are slower by more than this.
  EXPECT_LE(period, 5.0 * kPeriod) << "[s] by the stamps: the ticks come slower than ~rate";
  EXPECT_TRUE(cell_->proximity->running());
}

}  // namespace
}  // namespace test
}  // namespace hgrid
