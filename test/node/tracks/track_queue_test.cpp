// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#include "src/node/tracks/track_queue.h"

#include <gtest/gtest.h>

#include <boost/make_shared.hpp>
#include <string>
#include <thread>

namespace hgrid {
namespace {

constexpr std::chrono::milliseconds kNoWait{0};

ReceivedTracks messageOf(std::size_t size, char content) {
  const auto message = boost::make_shared<MessageBytes>();
  message->bytes.assign(size, content);
  message->size = size;
  return {message, {}};
}

TEST(TrackQueue, KeepsTheNewestMessagesInTheirOrder) {
  TrackQueue queue(3 * (100 + TrackQueue::kOverhead));
  for (const char content : {'a', 'b', 'c'}) EXPECT_EQ(queue.push(messageOf(100, content)), 0u);
  EXPECT_EQ(queue.push(messageOf(100, 'd')), 1u);
  EXPECT_EQ(queue.push(messageOf(200, 'e')), 2u) << "a longer one needs the room of two";
  std::string contents;
  while (const auto next = queue.popFor(kNoWait)) contents += next->message->bytes.front();
  EXPECT_EQ(contents, "de");
  for (const char content : {'f', 'g', 'h'})
    EXPECT_EQ(queue.push(messageOf(100, content)), 0u) << "there is room again";
}

TEST(TrackQueue, KeepsAMessageThatIsLongerThanItsBoundAlone) {
  TrackQueue queue(1000);
  queue.push(messageOf(10, 'a'));
  EXPECT_EQ(queue.push(messageOf(5000, 'b')), 1u);
  EXPECT_EQ(queue.popFor(kNoWait)->message->size, 5000u);
}

TEST(TrackQueue, EndsTheWaitForAMessage) {
  TrackQueue queue(1000);
  std::thread thread([&] { queue.end(); });
  EXPECT_FALSE(queue.popFor(std::chrono::hours(1)));
  thread.join();
  EXPECT_TRUE(queue.ended());
}

}  // namespace
}  // namespace hgrid
