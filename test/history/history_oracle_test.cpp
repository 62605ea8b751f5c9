// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#include <gtest/gtest.h>

#include <atomic>
#include <mutex>
#include <thread>

#include "hgrid_proximity/history/history.h"
#include "hgrid_proximity/narrow/core_narrow_phase.h"
#include "test/history/history_story.h"

namespace hgrid {
namespace {

using test::ChangingWorld;
using test::toldBy;

/// What the live snapshot of a tick said.
struct LiveTick {
  Time stamp{0};
  std::string told;
};

/// The ticks of a story. Several threads may use it.
class LiveTicks {
 public:
  void add(const Snapshot& snapshot, std::string told) {
    const std::lock_guard<std::mutex> lock(mutex_);
    ticks_.push_back({snapshot.stamp(), std::move(told)});
  }
  std::size_t size() const {
    const std::lock_guard<std::mutex> lock(mutex_);
    return ticks_.size();
  }
  Time stamp(std::size_t tick) const {
    const std::lock_guard<std::mutex> lock(mutex_);
    return ticks_[tick].stamp;
  }
  /// Returns what the last tick not later than `stamp` said.
  std::string toldAt(Time stamp) const {
    const std::lock_guard<std::mutex> lock(mutex_);
    const LiveTick* found = nullptr;
    for (const LiveTick& tick : ticks_) {
      if (tick.stamp <= stamp) found = &tick;
    }
    return found != nullptr ? found->told : "no tick";
  }

 private:
  mutable std::mutex mutex_;
  std::vector<LiveTick> ticks_;
};

TEST(HistoryOracle, APastTickAnswersByteForByteAsItDidWhenItWasNew) {
  const auto narrow_phase = makeCoreNarrowPhase();
  std::size_t asked = 0;
  for (unsigned seed = 1; seed <= 12; ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    ChangingWorld world(seed, narrow_phase);
    test::Random random(seed + 100);
    History history{HistoryLimits{}};
    LiveTicks live;
    for (int tick = 1; tick <= 50; ++tick) {
      std::shared_ptr<const Snapshot> newest = world.tick();
      live.add(*newest, toldBy(*newest, *narrow_phase, seed));
      history.add(newest);
      if (tick % 3 != 0) history.compact();  // sometimes a tick still waits
      for (int i = 0; i < 4; ++i) {
        const Time stamp = live.stamp(std::size_t(random.below(tick))) + Time{random.below(20000000)};
        if (stamp >= newest->stamp()) continue;
        const PastTick past = history.find(stamp, *newest);
        ASSERT_EQ(past.outcome, PastTick::Outcome::found);
        ASSERT_TRUE(toldBy(*past.snapshot, *narrow_phase, seed) == live.toldAt(stamp))
            << "tick " << past.snapshot->sequence() << ", asked at tick " << tick;
        ++asked;
      }
    }
    EXPECT_GT(history.extent().ticks, 30u);
    EXPECT_LT(history.extent().ticks, 50u) << "some ticks have the stamp of the tick before";
  }
  EXPECT_GT(asked, 1500u);
}

TEST(HistoryOracle, ThreadsMayAskWhileTicksGoOn) {
  const auto narrow_phase = makeCoreNarrowPhase();
  ChangingWorld world(5, narrow_phase);
  HistoryLimits limits;
  limits.span = std::chrono::milliseconds(300);  // so that ticks are dropped while they are asked
  History history(limits);
  LiveTicks live;
  std::shared_ptr<const Snapshot> newest = world.tick();
  live.add(*newest, toldBy(*newest, *narrow_phase, 1));
  history.add(newest);
  std::atomic<bool> ends{false};
  std::atomic<int> wrong{0}, right{0};
  const auto ask = [&](unsigned seed) {
    test::Random random(seed);
    while (!ends) {
      const std::shared_ptr<const Snapshot> now = std::atomic_load(&newest);
      const Time stamp = now->stamp() - Time{1 + random.below(400000000)};
      const PastTick past = history.find(stamp, *now);
      if (past.outcome != PastTick::Outcome::found) continue;
      (toldBy(*past.snapshot, *narrow_phase, 1) == live.toldAt(stamp) ? right : wrong) += 1;
    }
  };
  std::vector<std::thread> threads;
  for (unsigned seed : {1u, 2u}) threads.emplace_back(ask, seed);
  threads.emplace_back([&] {
    while (!ends) history.compact();
  });
  for (int tick = 2; tick <= 100 || right < 100; ++tick) {
    const std::shared_ptr<const Snapshot> next = world.tick();
    live.add(*next, toldBy(*next, *narrow_phase, 1));
    history.add(next);
    std::atomic_store(&newest, next);
    if (tick > 20000 || wrong > 0) break;
  }
  ends = true;
  for (std::thread& thread : threads) thread.join();
  EXPECT_EQ(wrong, 0);
  EXPECT_GE(right, 100);
}

}  // namespace
}  // namespace hgrid
