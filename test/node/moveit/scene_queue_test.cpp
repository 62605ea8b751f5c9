// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#include "src/node/moveit/scene_queue.h"

#include <gtest/gtest.h>

#include <boost/make_shared.hpp>
#include <thread>

namespace hgrid {
namespace {

ReceivedScene sceneOf(std::size_t bytes, const std::string& publisher = "/planner") {
  const auto message = boost::make_shared<MessageBytes>();
  message->most_bytes = 1 << 20;
  const std::string data(bytes, 'x');
  message->read(reinterpret_cast<const std::uint8_t*>(data.data()), data.size());
  return {SceneTopic::planning_scene, "md5", publisher, message};
}

TEST(SceneQueueTest, ReturnsTheMessagesInTheirOrder) {
  SceneQueue queue(1 << 20);
  for (const char* publisher : {"/a", "/b", "/c"}) EXPECT_TRUE(queue.push(sceneOf(10, publisher)));
  const std::vector<ReceivedScene> all = queue.popAll().messages;
  ASSERT_EQ(all.size(), 3u);
  EXPECT_EQ(all[0].publisher, "/a");
  EXPECT_EQ(all[2].name(), "the message on planning_scene from '/c'");
}

TEST(SceneQueueTest, RefusesMessagesThatExceedItsBound) {
  SceneQueue queue(2 * (100 + SceneQueue::kOverhead));
  EXPECT_FALSE(queue.push(sceneOf(200 + SceneQueue::kOverhead + 1)));
  EXPECT_TRUE(queue.push(sceneOf(100)));
  EXPECT_FALSE(queue.push(sceneOf(101)));
  EXPECT_TRUE(queue.push(sceneOf(100)));
  EXPECT_FALSE(queue.push(sceneOf(0)));
  EXPECT_EQ(queue.popAll().messages.size(), 2u);
  EXPECT_TRUE(queue.push(sceneOf(100))) << "there is room again";
}

TEST(SceneQueueTest, SaysAfterWhichMessagesTheNewestWasDropped) {
  SceneQueue queue(1 << 20);
  queue.noteDropped(true);
  queue.push(sceneOf(1));
  queue.push(sceneOf(1));
  queue.noteDropped(false);
  queue.push(sceneOf(1));
  const SceneQueue::Popped popped = queue.popAll();
  EXPECT_EQ(popped.messages.size(), 3u);
  EXPECT_EQ(popped.dropped_at, std::optional<std::size_t>(2));
  EXPECT_TRUE(popped.dropped_scene) << "the older one was a planning scene";
  queue.noteDropped(false);
  const SceneQueue::Popped next = queue.popAll();
  EXPECT_EQ(next.dropped_at, std::optional<std::size_t>(0)) << "even if no message waits";
  EXPECT_FALSE(next.dropped_scene);
  queue.push(sceneOf(1));
  EXPECT_FALSE(queue.popAll().dropped_at);
}

TEST(SceneQueueTest, EndsAWaitThatFindsNoMessage) {
  SceneQueue queue(1 << 20);
  std::thread waiting([&] { EXPECT_TRUE(queue.popAll().ended); });
  queue.end();
  waiting.join();
}

}  // namespace
}  // namespace hgrid
