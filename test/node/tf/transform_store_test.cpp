// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#include "src/node/tf/transform_store.h"

#include <gtest/gtest.h>

#include <atomic>
#include <cmath>
#include <functional>
#include <optional>
#include <string>
#include <thread>

#include "src/node/tf/transform_lookup.h"
#include "test/node/support/moments.h"

namespace hgrid {
namespace test {
namespace {

PoseSample stored(double time, double x) {
  PoseSample result;
  result.stamp = s(time);
  result.parent_from_frame.translation.x() = x;
  return result;
}

TEST(TransformStore, KeepsTransformsForAsLongAsTheCache) {
  TransformStore store(s(10), 100);
  const std::uint32_t arm = store.admit("base", "arm");
  for (int time = 100; time <= 120; ++time) store.advance(arm, "base", stored(time, time), s(time));
  EXPECT_TRUE(store.history(arm).at(s(110)));
  EXPECT_FALSE(store.history(arm).at(s(109.9)));
  EXPECT_FALSE(store.fill(arm, stored(109.5, 0)));
  EXPECT_TRUE(store.fill(arm, stored(110.5, 0)));
}

TEST(TransformStore, DropsNothingBecauseOfAStampFarAheadOfTheClock) {
  TransformStore store(s(10), 100);
  const std::uint32_t arm = store.admit("base", "arm");
  for (int time = 100; time <= 110; ++time) store.advance(arm, "base", stored(time, time), s(time));
  store.advance(arm, "base", stored(1000, 0), s(110));
  EXPECT_TRUE(store.history(arm).at(s(105)));
}

TEST(TransformStore, KeepsAtMostMaxSamplesOfEachFrameAndCountsTheOthers) {
  TransformStore store(s(100), 100, 5);
  const std::uint32_t arm = store.admit("base", "arm"), cart = store.admit("base", "cart");
  for (int time = 1; time <= 12; ++time) store.advance(arm, "base", stored(time, time), s(time));
  store.advance(cart, "base", stored(1, 1), s(1));
  EXPECT_EQ(store.takeDropped(), 7u);
  EXPECT_EQ(store.takeDropped(), 0u);
  EXPECT_TRUE(store.history(arm).at(s(8)));
  EXPECT_FALSE(store.history(arm).at(s(7.9)));
  EXPECT_TRUE(store.history(cart).at(s(1)));
  EXPECT_TRUE(store.fill(arm, stored(9.5, 0))) << "an older sample takes the room of the oldest";
  EXPECT_EQ(store.takeDropped(), 1u);
  EXPECT_FALSE(store.history(arm).at(s(8)));
  EXPECT_FALSE(store.fill(arm, stored(8.5, 0)));
}

TEST(TransformStore, SetsTheParentOfASample) {
  TransformStore store(s(10), 100);
  const std::uint32_t arm = store.admit("base", "arm");
  store.advance(arm, "base", stored(1, 0), s(1));
  EXPECT_EQ(store.table().name(store.history(arm).newest().parent), "base");
  store.advance(arm, "cart", stored(2, 0), s(2));
  EXPECT_EQ(store.table().name(store.history(arm).newest().parent), "cart");
  EXPECT_EQ(store.table().parentName(arm), "cart");
  store.fix(arm, "wall", {});
  EXPECT_EQ(store.table().name(store.history(arm).newest().parent), "wall");
  EXPECT_FALSE(store.history(arm).moves());
}

/// Calls `look` again and again in one thread, and `write` with the numbers 0, 1, 2, ... in the calling thread, until
/// both were called often enough. Returns the largest absolute value that `look` returned.
/// @param look  returns nullopt if there is nothing to see yet
double largestSeen(const std::function<std::optional<double>()>& look, const std::function<void(int)>& write) {
  std::atomic<bool> stop{false};
  std::atomic<int> looks{0};
  double largest = 0.0;
  std::thread reader([&] {
    while (!stop) {
      const std::optional<double> seen = look();
      if (!seen) continue;
      largest = std::max(largest, std::abs(*seen));
      ++looks;
    }
  });
  for (int written = 0; written < 2000 || (looks < 5000 && written < 20000000); ++written) write(written);
  stop = true;
  reader.join();
  EXPECT_GE(looks, 5000);
  return largest;
}

// A thread writes two transforms of one chain. They always have opposite x, so their sum is 0. Another thread that
// reads meanwhile must never get a pose that mixes two times. ThreadSanitizer reports a missing lock.
TEST(TransformStore, IsReadByOtherThreadsWhileItIsWritten) {
  TransformStore store(s(1), 1000);
  const TransformLookup lookup(store);
  const auto look = [&] {
    const auto pose = lookup.newest("base", "tool");
    lookup.at("base", "tool", s(5));
    return pose ? std::optional<double>(pose->translation.x()) : std::nullopt;
  };
  const auto write = [&](int number) {
    const double time = 1.0 + 0.01 * number, x = number % 7;
    store.advance(store.admit("base", "arm"), "base", stored(time, x), s(time));
    store.advance(store.admit("arm", "tool"), "arm", stored(time, -x), s(time));
    const std::string other = "other" + std::to_string(number % 500);
    store.fix(store.admit("base", other), "base", {});
  };
  EXPECT_EQ(largestSeen(look, write), 0.0);
}

// A thread changes two frames during one Writing. They always have opposite x. Another thread must never see only one
// of the two changes.
TEST(TransformStore, ShowsTheChangesOfOneWritingTogether) {
  TransformStore store(s(1), 1000);
  const std::uint32_t arm = store.admit("base", "arm"), tool = store.admit("arm", "tool");
  const auto look = [&]() -> std::optional<double> {
    const TransformStore::Reading reading(store);
    return reading.history(arm).newest().parent_from_frame.translation.x() +
           reading.history(tool).newest().parent_from_frame.translation.x();
  };
  const auto write = [&](int number) {
    const double time = 1.0 + 0.01 * number, x = number % 7;
    const TransformStore::Writing writing(store);
    store.advance(arm, "base", stored(time, x), s(time));
    if (number % 10 == 0) std::this_thread::yield();  // now the reader would see only the first change
    store.advance(tool, "arm", stored(time, -x), s(time));
  };
  EXPECT_EQ(largestSeen(look, write), 0.0);
}

TEST(TransformStore, IsReadByOtherThreadsDuringAPause) {
  TransformStore store(s(1), 1000);
  const TransformStore::Writing writing(store);
  store.admit("base", "arm");
  std::size_t frames = 0;
  {
    const TransformStore::Pause pause(store);
    std::thread([&] { frames = TransformStore::Reading(store).table().size(); }).join();  // would wait forever
    store.admit("base", "tool");  // a change during a pause locks and unlocks by itself
    std::thread([&] { frames += TransformStore::Reading(store).table().size(); }).join();
  }
  EXPECT_EQ(frames, 1u + 2u);
}

}  // namespace
}  // namespace test
}  // namespace hgrid
