// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#include "src/node/threads/quick_callbacks.h"

#include <gtest/gtest.h>
#include <ros/callback_queue.h>

#include <boost/make_shared.hpp>
#include <functional>
#include <stdexcept>
#include <string>
#include <thread>

#include "src/node/threads/quick_turn.h"

namespace hgrid {
namespace test {
namespace {

struct Callback : ros::CallbackInterface {
  explicit Callback(std::function<void()> work) : does(std::move(work)) {}
  CallResult call() override {
    does();
    return Success;
  }
  std::function<void()> does;
};

/// Calls of callbacks are noted as a letter, which is a capital one in a QuickTurn.
class QuickCallbacksTest : public ::testing::Test {
 protected:
  /// Adds a callback. @param is_short  whether it can run in a QuickTurn
  void add(char letter, bool is_short = true, std::uint64_t owner = 1) {
    pause();
    addNow(letter, is_short, owner);
  }
  void addNow(char letter, bool is_short = true, std::uint64_t owner = 1) {
    const auto note = [this, letter, is_short] {
      QuickTurn::require(is_short);
      calls_ += static_cast<char>(QuickTurn::here() ? letter - 'a' + 'A' : letter);
    };
    quick_.addCallback(boost::make_shared<Callback>(note), owner);
  }
  static void pause() { std::this_thread::sleep_for(2 * QuickCallbacks::kPause); }
  void callOthers() {
    others_.callAvailable();
    pause();
  }

  ros::CallbackQueue others_;
  QuickCallbacks quick_{others_};
  std::string calls_;
};

TEST_F(QuickCallbacksTest, RunAtOnceIfTheyAreShort) {
  add('a');
  EXPECT_EQ(calls_, "A");
  add('b', false);
  EXPECT_EQ(calls_, "A");
  callOthers();
  EXPECT_EQ(calls_, "Ab");
  add('c');
  EXPECT_EQ(calls_, "AbC");
  EXPECT_FALSE(QuickTurn::here());
}

TEST_F(QuickCallbacksTest, DoNotRunAtOnceWhileAnotherOneWaitsOrRuns) {
  add('a', false);
  add('b');  // the first one waits
  others_.callOne();
  add('c');  // the second one waits
  EXPECT_EQ(calls_, "a");
  callOthers();
  EXPECT_EQ(calls_, "abc");
  const auto add_another = [this] {
    QuickTurn::require(false);
    add('e');
    calls_ += 'd';
  };
  quick_.addCallback(boost::make_shared<Callback>(add_another), 1);
  others_.callOne();
  EXPECT_EQ(calls_, "abcd") << "the callback that was added meanwhile waits";
  callOthers();
  add('f');
  EXPECT_EQ(calls_, "abcdeF");
}

TEST_F(QuickCallbacksTest, ThatAreRemovedBlockNoOthers) {
  add('a', false, 7);
  quick_.removeByID(7);
  add('b');
  EXPECT_EQ(calls_, "B");
  others_.disable();
  add('c', false);
  add('d');
  EXPECT_EQ(calls_, "BD") << "a disabled queue drops what is passed to it";
}

TEST_F(QuickCallbacksTest, RunAgainElsewhereAfterAnError) {
  int runs = 0;
  const auto fail_once = [&] {
    if (++runs == 1) throw std::runtime_error("an error");
  };
  quick_.addCallback(boost::make_shared<Callback>(fail_once), 1);
  EXPECT_EQ(runs, 1);
  EXPECT_FALSE(QuickTurn::here());
  others_.callAvailable();
  EXPECT_EQ(runs, 2);
}

TEST_F(QuickCallbacksTest, DoNotFollowEachOtherWithoutAPause) {
  std::size_t passed = 0;
  for (int i = 0; i < 100; ++i) {
    const std::size_t before = calls_.size();
    add('a');
    addNow('b');
    if (calls_.size() == before + 1) ++passed;  // unless something interrupted this thread between the two
    callOthers();
  }
  EXPECT_GT(passed, 0u);
}

TEST_F(QuickCallbacksTest, AddedByAnotherOneGoElsewhere) {
  const auto add_another = [this] {
    calls_ += 'a';
    add('b');
  };
  quick_.addCallback(boost::make_shared<Callback>(add_another), 1);
  EXPECT_EQ(calls_, "a");
  callOthers();
  EXPECT_EQ(calls_, "ab");
}

TEST_F(QuickCallbacksTest, DoNotRunAtOnceAfterStop) {
  std::atomic<bool> begun{false}, ended{false};
  const auto run_long = [&] {
    begun = true;
    for (int i = 0; i < 100000; ++i) std::this_thread::yield();
    ended = true;
  };
  std::thread receiving([&] { quick_.addCallback(boost::make_shared<Callback>(run_long), 1); });
  while (!begun) std::this_thread::yield();
  quick_.stop();
  EXPECT_TRUE(ended) << "stop() waits";
  receiving.join();
  add('a');
  EXPECT_EQ(calls_, "");
  callOthers();
  EXPECT_EQ(calls_, "a");
}

}  // namespace
}  // namespace test
}  // namespace hgrid
