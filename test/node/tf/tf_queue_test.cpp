// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
//
// These tests need no ROS master.
#include "src/node/tf/tf_queue.h"

#include <gtest/gtest.h>

#include <boost/make_shared.hpp>
#include <thread>

namespace hgrid {
namespace test {
namespace {

constexpr std::size_t kBound = 10000;  // [bytes]

/// Returns a message of `size` bytes that arrived at the time `at` [ms].
ReceivedTransforms message(std::size_t size, int at, bool is_static = false) {
  const auto bytes = boost::make_shared<MessageBytes>();
  bytes->most_bytes = kBound;
  bytes->read(reinterpret_cast<const std::uint8_t*>(std::string(size, 'x').data()), size);
  ReceivedTransforms transforms{bytes, is_static, "/robot", {}};
  transforms.received.steady += std::chrono::milliseconds(at);
  return transforms;
}

int arrivalOf(const ReceivedTransforms& transforms) {
  return static_cast<int>(
      std::chrono::duration_cast<std::chrono::milliseconds>(transforms.received.steady.time_since_epoch()).count());
}

/// Removes all messages. Returns their arrival times [ms] in the order in which the queue returned the messages.
std::vector<int> drain(TfQueue& queue) {
  std::vector<int> arrivals;
  while (const auto next = queue.pop()) arrivals.push_back(arrivalOf(*next));
  EXPECT_TRUE(queue.empty());
  return arrivals;
}

std::uint64_t countOf(const Ledger& ledger, const std::string& counter) {
  const auto counters = ledger.counters();
  const auto found = counters.find(counter);
  return found == counters.end() ? 0 : found->second;
}

class TfQueueTest : public ::testing::Test {
 protected:
  std::uint64_t dropped() const { return countOf(ledger_, "tf.dropped.LIMIT"); }
  std::uint64_t refused() const { return countOf(ledger_, "tf.refused.LIMIT"); }

  Ledger ledger_;
  TfQueue queue_{kBound, ledger_};
};

TEST_F(TfQueueTest, ReturnsMessagesOfBothTopicsInTheOrderInWhichTheyArrived) {
  queue_.push(message(10, 1));
  queue_.push(message(10, 2));
  queue_.push(message(10, 3, true));
  queue_.push(message(10, 4));
  queue_.push(message(10, 5, true));
  EXPECT_FALSE(queue_.empty());
  EXPECT_EQ(drain(queue_), std::vector<int>({1, 2, 3, 4, 5}));
  EXPECT_FALSE(queue_.pop());
}

TEST_F(TfQueueTest, KeepsWhatAMessageArrivedWith) {
  queue_.push(message(10, 7, true));
  const auto next = queue_.pop();
  ASSERT_TRUE(next);
  EXPECT_TRUE(next->is_static);
  EXPECT_EQ(next->publisher, "/robot");
  EXPECT_EQ(next->message->bytes, std::string(10, 'x'));
  EXPECT_EQ(next->name(), "the message on /tf_static from '/robot'");
}

TEST_F(TfQueueTest, DropsTheOldestWhenTheBytesExceedTheBound) {
  const std::size_t each = 1000, charged = each + TfQueue::kOverhead + std::string("/robot").size();
  const int fit = kBound / charged;
  for (int i = 0; i < fit; ++i) queue_.push(message(each, i));
  EXPECT_EQ(dropped(), 0u) << "messages up to the bound are kept";
  for (int i = fit; i < 100; ++i) queue_.push(message(each, i));
  const std::vector<int> left = drain(queue_);
  EXPECT_EQ(left.size(), fit);
  EXPECT_EQ(left.front(), 100 - fit);
  EXPECT_EQ(left.back(), 99);
  EXPECT_EQ(dropped(), 100u - fit);
  queue_.push(message(each, 100));
  EXPECT_EQ(drain(queue_), std::vector<int>({100})) << "messages that were removed no longer count";
  EXPECT_EQ(dropped(), 100u - fit);
}

TEST_F(TfQueueTest, CountsAnOverheadForEachMessageSoThatEmptyOnesAreBoundedToo) {
  for (int i = 0; i < 10000; ++i) queue_.push(message(0, i));
  EXPECT_LE(drain(queue_).size(), kBound / TfQueue::kOverhead);
}

TEST_F(TfQueueTest, KeepsStaticTransformsInAFloodOfMovingOnes) {
  queue_.push(message(1000, 0, true));
  for (int i = 1; i < 1000; ++i) queue_.push(message(1000, i));
  EXPECT_EQ(drain(queue_).front(), 0);
}

TEST_F(TfQueueTest, RefusesAMessageThatIsLongerThanTheBoundAndKeepsTheOthers) {
  queue_.push(message(10, 1));
  queue_.push(message(kBound + 1, 2));
  EXPECT_EQ(refused(), 1u);
  EXPECT_EQ(drain(queue_), std::vector<int>({1}));
  EXPECT_EQ(dropped(), 0u);
}

TEST_F(TfQueueTest, AcceptsAMessageAsLongAsTheBound) {
  queue_.push(message(10, 1));
  queue_.push(message(kBound, 2));
  EXPECT_EQ(drain(queue_), std::vector<int>({2}));
  EXPECT_EQ(refused(), 0u);
  EXPECT_EQ(dropped(), 1u);
}

TEST_F(TfQueueTest, StoresNoBytesOfAMessageThatIsTooLong) {
  EXPECT_EQ(message(kBound + 1, 0).message->bytes.capacity(), std::string().capacity());
  EXPECT_EQ(message(kBound + 1, 0).message->size, kBound + 1);
}

TEST_F(TfQueueTest, LosesNoMessageBetweenTwoThreads) {
  constexpr int kMessages = 20000;
  std::atomic<bool> done{false};
  std::size_t taken = 0;
  int last = -1;
  std::thread reader([&] {
    while (!done || !queue_.empty()) {
      const auto next = queue_.pop();
      if (!next) continue;
      EXPECT_GT(arrivalOf(*next), last);
      last = arrivalOf(*next);
      ++taken;
    }
  });
  for (int i = 0; i < kMessages; ++i) queue_.push(message(100, i));
  done = true;
  reader.join();
  EXPECT_EQ(taken + dropped(), kMessages);
  EXPECT_EQ(last, kMessages - 1) << "the newest message is never dropped";
}

}  // namespace
}  // namespace test
}  // namespace hgrid
