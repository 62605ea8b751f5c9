// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#include "src/node/threads/newest_only.h"

#include <gtest/gtest.h>

#include <atomic>
#include <chrono>
#include <future>
#include <vector>

namespace hgrid {
namespace {

TEST(NewestOnly, DropsTheValueThatWaitsWhenANewerOneArrives) {
  std::promise<void> begun, may_end, all_done;
  std::vector<int> done;
  NewestOnly<int> thread([&](const int& value) {
    done.push_back(value);
    if (value == 1) {
      begun.set_value();
      may_end.get_future().wait();
    }
    if (value == 3) all_done.set_value();
  });
  EXPECT_FALSE(thread.give(1));
  begun.get_future().wait();
  EXPECT_FALSE(thread.give(2)) << "the work on 1 has begun, so 1 is not dropped";
  EXPECT_TRUE(thread.give(3)) << "2 still waits";
  may_end.set_value();
  all_done.get_future().wait();
  EXPECT_EQ(done, std::vector<int>({1, 3}));
}

TEST(NewestOnly, WaitsForTheValuesThatWerePassedBefore) {
  std::promise<void> begun, may_end;
  std::atomic<int> done{0};
  NewestOnly<int> thread([&](const int& value) {
    if (value == 1) {
      begun.set_value();
      may_end.get_future().wait();
    }
    done = value;
  });
  thread.wait();  // nothing was passed
  thread.give(1);
  begun.get_future().wait();
  thread.give(2);
  auto waited = std::async(std::launch::async, [&] {
    thread.wait();
    return done.load();
  });
  // A slow machine cannot make this fail. It only makes it more likely that a faulty wait() is not noticed.
  EXPECT_EQ(waited.wait_for(std::chrono::milliseconds(20)), std::future_status::timeout) << "1 and 2 are not done";
  may_end.set_value();
  EXPECT_EQ(waited.get(), 2);
}

}  // namespace
}  // namespace hgrid
