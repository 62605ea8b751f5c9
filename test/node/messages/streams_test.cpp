// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#include <hgrid_proximity/Mobility.h>
#include <hgrid_proximity/ShapeKind.h>
#include <ros/serialization.h>

#include "test/node/support/claims.h"
#include "test/node/support/descriptions.h"
#include "test/node/support/transform_source.h"

namespace hgrid {
namespace test {
namespace {

using diagnostic_msgs::DiagnosticStatus;

TEST(Streams, SpeakEveryTickAlsoWhenThereIsNothingToSay) {
  NodeSetup setup;
  setup.params = dict(
      {{"world_frame", "base"}, {"rate", 20.0}, {"accept_uncovered", list({waiver("robot/*", "there is no robot")})}});
  setup.beside["robot_description"] = urdf(link("base"));
  NodeUnderTest node(setup);
  node.waitForComplete();
  const Heard before = node.heard();
  node.waitForTicks(30);
  const Heard after = node.heard();
  for (std::size_t i = before.pairs.size(); i < after.pairs.size(); ++i) {
    const msg::Pairs& pairs = *after.pairs[i];
    EXPECT_EQ(pairs.world.sequence, after.pairs[i - 1]->world.sequence + 1) << "no tick is left out";
    EXPECT_TRUE(pairs.names.empty() && pairs.first.empty() && pairs.total == 0 && !pairs.truncated);
    EXPECT_TRUE(pairs.world.complete);
    EXPECT_EQ(pairs.header.frame_id, "base");
    EXPECT_EQ(pairs.header.stamp, pairs.world.stamp);
    EXPECT_EQ(pairs.world.epoch, before.pairs.back()->world.epoch);
    EXPECT_EQ(pairs.world.config_hash, before.pairs.back()->world.config_hash);
    EXPECT_GE(pairs.header.stamp, after.pairs[i - 1]->header.stamp);
  }
  for (std::size_t i = before.status.size(); i < after.status.size(); ++i) {
    EXPECT_EQ(after.status[i]->world.sequence, after.status[i - 1]->world.sequence + 1) << "no tick is left out";
    EXPECT_EQ(after.status[i]->bodies_total, 0u);
  }
  EXPECT_FALSE(after.status.back()->timings.empty());
  EXPECT_GT(after.status.back()->timing_ticks, 0u);
}

TEST(Streams, SpeakEveryTickAlsoWhenThereIsNoWorld) {
  NodeUnderTest node(NodeSetup{});
  node.waitForTicks(10);
  const Heard all = node.heard();
  EXPECT_FALSE(all.pairs.back()->world.complete);
  EXPECT_EQ(all.pairs.back()->world.sequence, 0u);
  EXPECT_TRUE(oneSays(all.status.back()->not_ready, "the world frame is the root of a robot that is not loaded yet"));
}

TEST(Streams, ALateSubscriberGetsTheStructureAtOnceAndTheNextTick) {
  NodeSetup setup;
  setup.params = dict({{"obstacles", list({ball("post", 2, 0, 0, 0.1)})}});
  setup.beside["robot_description"] = balls({});
  NodeUnderTest node(setup);
  node.waitForComplete();
  node.waitForTicks(20);
  EXPECT_LE(node.heard().bodies.size(), 2u) << "~bodies is published only when it changes";

  std::mutex mutex;
  std::condition_variable news;
  msg::Bodies::ConstPtr bodies;
  msg::Pairs::ConstPtr pairs;
  ros::NodeHandle handle;
  const ros::Subscriber late_bodies =
      handle.subscribe<msg::Bodies>(node.named("bodies"), 1, [&](const msg::Bodies::ConstPtr& message) {
        const std::lock_guard<std::mutex> lock(mutex);
        bodies = message;
        news.notify_all();
      });
  const ros::Subscriber late_pairs =
      handle.subscribe<msg::Pairs>(node.named("pairs"), 1, [&](const msg::Pairs::ConstPtr& message) {
        const std::lock_guard<std::mutex> lock(mutex);
        pairs = message;
        news.notify_all();
      });
  std::unique_lock<std::mutex> lock(mutex);
  ASSERT_TRUE(news.wait_for(lock, std::chrono::seconds(20), [&] { return bodies && pairs; }));
  EXPECT_EQ(bodies->bodies_revision, pairs->world.bodies_revision);
  EXPECT_EQ(bodies->epoch, pairs->world.epoch);
  EXPECT_EQ(bodies->header.frame_id, "base");
  ASSERT_EQ(bodies->bodies.size(), 2u);
  const msg::Body &post = bodies->bodies[0], &base = bodies->bodies[1];
  EXPECT_EQ(post.name, "obstacle/post");
  EXPECT_EQ(post.frame, "base");
  EXPECT_EQ(post.mobility, msg::Mobility::FIXED);
  EXPECT_EQ(post.robot, "");
  ASSERT_EQ(post.shapes.size(), 1u);
  EXPECT_EQ(post.shapes[0].kind, msg::ShapeKind::SPHERE);
  EXPECT_EQ(post.shapes[0].dimensions, std::vector<double>({0.1}));
  EXPECT_EQ(base.name, "robot/base");
  EXPECT_EQ(base.robot, "robot");
  EXPECT_EQ(base.mobility, msg::Mobility::MOVING);
  EXPECT_EQ(base.shapes.at(0).pose.position.z, -5.0);
  EXPECT_EQ(base.shapes.at(0).scale.x, 1.0);
  EXPECT_EQ(base.margin, 0.1);
}

/// Serializes the pairs of a message without header, world and `since`, because these differ between nodes.
std::vector<std::uint8_t> bytesOf(const msg::Pairs& pairs) {
  msg::Pairs bare = pairs;
  bare.header = {};
  bare.world = {};
  bare.since.clear();
  std::vector<std::uint8_t> bytes(ros::serialization::serializationLength(bare));
  ros::serialization::OStream stream(bytes.data(), static_cast<std::uint32_t>(bytes.size()));
  ros::serialization::serialize(stream, bare);
  return bytes;
}

TEST(Streams, TwoNodesSayTheSameOfTheSameWorldByteForByte) {
  TransformSource transforms;
  Value forth = list(), back = list();
  for (int i = 0; i < 40; ++i) {
    const int k = (17 * i) % 40;
    const auto post = [](int n) {
      return ball("post_" + std::to_string(n), 0.1 * (n % 7), 0.13 * (n % 5), 0.17 * (n % 3), 0.02 + 0.003 * n);
    };
    forth[i] = post(i);
    back[i] = post(k);
  }
  const auto setup = [](const Value& obstacles) {
    NodeSetup setup;
    setup.params =
        dict({{"obstacles", obstacles}, {"stale_after", 3600.0}, {"lost_after", 3600.0}, {"late_after", 3600.0}});
    setup.beside["robot_description"] = balls({"a", "b", "c"});
    return setup;
  };
  NodeUnderTest one(setup(forth)), other(setup(back));
  transforms.waitForListeners(2);
  const auto send = [&](const ros::Time& time) {
    transforms.send({stamped("base", "a", at(0.1, 0.2, 0.3, 0.4), time),
                     stamped("base", "b", at(0.2, 0.1, 0.0, 1.0), time),
                     stamped("base", "c", at(0.3, 0.3, 0.1, 2.0), time)});
  };
  send(transforms.now());
  const auto complete = [](const msg::Pairs& pairs) { return pairs.world.complete; };
  one.waitForPairs("the world is complete", complete);
  other.waitForPairs("the world is complete", complete);
  // Before the first transforms came, each tick had the ROS time at which it was made. If such a tick was made after
  // these transforms were stamped, the next ticks keep its time, and the poses, which are older, are LATE. So the
  // messages that are compared are those of a tick that both nodes make for the same, later time.
  const ros::Time later = transforms.now();
  send(later);
  const auto is_later = [&](const msg::Pairs& pairs) { return pairs.header.stamp == later; };
  const auto of_one = one.waitForPairs("the later transforms are used", is_later);
  const auto of_other = other.waitForPairs("the later transforms are used", is_later);
  EXPECT_GT(of_one->total, 30u);
  EXPECT_EQ(of_one->total, of_other->total);
  EXPECT_EQ(of_one->names, of_other->names);
  EXPECT_EQ(of_one->margin, of_other->margin);
  EXPECT_EQ(of_one->gap, of_other->gap);
  EXPECT_EQ(of_one->state, of_other->state);
  EXPECT_EQ(bytesOf(*of_one), bytesOf(*of_other));
}

TEST(Diagnostics, HasSixStatuses) {
  NodeSetup setup;
  setup.beside["robot_description"] = balls({"a", "b"});
  NodeUnderTest node(setup);
  node.waitUntil("all statuses", [](const Heard& all) { return all.diagnostics.size() >= 6; });
  const auto all = node.heard().diagnostics;
  EXPECT_EQ(all.size(), 6u);
  for (const char* name : {"world", "robots", "transforms", "ticks", "audit", "state"})
    EXPECT_EQ(all.count(name), 1u) << name;
  node.waitUntil("the missing frame is reported", [](const Heard& heard) {
    const auto& world = heard.diagnostics.at("world");
    const auto& transforms = heard.diagnostics.at("transforms");
    return world.level == DiagnosticStatus::ERROR && world.message.find("UNPLACED robot/a") != std::string::npos &&
           transforms.level == DiagnosticStatus::ERROR && transforms.message.find("'a'") != std::string::npos;
  });
  TransformSource transforms;
  transforms.fix({stamped("base", "a", at(0)), stamped("base", "b", at(9))});
  node.waitUntil("all statuses are OK", [](const Heard& heard) {
    return heard.diagnostics.at("world").level == DiagnosticStatus::OK &&
           heard.diagnostics.at("transforms").level == DiagnosticStatus::OK &&
           heard.diagnostics.at("robots").level == DiagnosticStatus::OK;
  });
}

}  // namespace
}  // namespace test
}  // namespace hgrid
