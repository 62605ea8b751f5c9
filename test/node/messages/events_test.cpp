// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#include "test/node/support/claims.h"
#include "test/node/support/descriptions.h"
#include "test/node/support/transform_source.h"

namespace hgrid {
namespace test {
namespace {

using Told = std::vector<std::string>;

/// Two spheres of one robot: "a" rests at 0, near a post; the test moves "b". Late poses stay FRESH, because otherwise
/// a busy machine would cause events.
class Events : public ::testing::Test {
 protected:
  Events() : node_(setup()) {
    transforms_.fix({stamped("base", "a", at(0))});
    transforms_.stream("base", "b", at(1.0));
    node_.waitForComplete();
    waitForEvents(1);
  }
  static NodeSetup setup() {
    NodeSetup setup;
    setup.params = dict({{"late_after", 3600.0},
                         {"stale_after", 3600.0},
                         {"lost_after", 3600.0},
                         {"obstacles", list({ball("post", -0.25, 0, 0, 0.1)})}});
    setup.beside["robot_description"] = balls({"a", "b"});
    return setup;
  }
  static Told allOf(const Heard& heard) {
    Told told;
    for (const auto& message : heard.events) {
      for (const std::string& event : eventsOf(*message)) told.push_back(event);
    }
    return told;
  }
  Told told() const { return allOf(node_.heard()); }
  void waitForEvents(std::size_t count) {
    node_.waitUntil(std::to_string(count) + " events",
                    [&](const Heard& heard) { return allOf(heard).size() >= count; });
  }
  /// Moves b to x [m]. Waits for this number of pairs, and for this number of events in total.
  void move(double x, std::uint32_t pairs, std::size_t events) {
    transforms_.stream("base", "b", at(x));
    node_.waitForPairs("b at " + std::to_string(x), [&](const msg::Pairs& p) { return p.total == pairs; });
    waitForEvents(events);
    node_.waitForTicks(3);  // in these ticks the node could report an event that it should not report
  }

  TransformSource transforms_;
  NodeUnderTest node_;
};

TEST_F(Events, ComeOnceEachNumberedFrom1AndWithHysteresis) {
  EXPECT_EQ(told(), Told({"1 BEGIN BODIES obstacle/post|robot/a"}));
  move(0.25, 2, 2);
  for (const double x : {0.31, 0.25, 0.31}) move(x, x > 0.3 ? 1 : 2, 2);
  EXPECT_EQ(told().size(), 2u) << "0.11 m exceed the margin, but not by the hysteresis";
  move(0.4, 1, 3);
  EXPECT_EQ(told(), Told({"1 BEGIN BODIES obstacle/post|robot/a", "2 BEGIN MOVED robot/a|robot/b",
                          "3 END MOVED robot/a|robot/b"}));

  const auto begin = node_.heard().events.at(1), end = node_.heard().events.at(2);
  EXPECT_EQ(begin->header.frame_id, "base");
  EXPECT_EQ(begin->since.at(0), begin->header.stamp);
  EXPECT_EQ(begin->world.last_event, 2u);
  EXPECT_LE(begin->gap.at(0), 0.1);
  EXPECT_EQ(end->since.at(0), begin->header.stamp) << "the stamp at which the pair began";
  EXPECT_GT(end->header.stamp, begin->header.stamp);
  EXPECT_GT(end->gap.at(0), 0.12);
  EXPECT_NEAR(end->distance.at(0), end->gap.at(0), 1e-6) << "gap and distance are equal for spheres on one axis";
  EXPECT_EQ(end->world.last_event, 3u);
  EXPECT_EQ(end->world.epoch, begin->world.epoch);
}

TEST_F(Events, ThatALateSubscriberMissedShowInTheirNumbers) {
  move(0.25, 2, 2);
  EXPECT_EQ(node_.heard().pairs.back()->world.last_event, 2u);
  EXPECT_EQ(node_.heard().status.back()->world.last_event, 2u);
  EXPECT_EQ(node_.sphere(0, 0, 0, 0.05).world.last_event, 2u) << "answers contain it as well";

  std::mutex mutex;
  std::vector<msg::Events> heard;
  ros::NodeHandle node;
  const ros::Subscriber late =
      node.subscribe<msg::Events>(node_.named("events"), 100, [&](const msg::Events::ConstPtr& message) {
        const std::lock_guard<std::mutex> lock(mutex);
        heard.push_back(*message);
      });
  const auto count = [&] {
    const std::lock_guard<std::mutex> lock(mutex);
    return heard.size();
  };
  node_.waitUntil("the late subscriber is connected", [&](const Heard&) { return late.getNumPublishers() > 0; });
  node_.waitForTicks(3);
  EXPECT_EQ(count(), 0u) << "past events are not sent again";
  move(0.4, 1, 3);
  node_.waitUntil("the end", [&](const Heard&) { return count() > 0; });
  const std::lock_guard<std::mutex> lock(mutex);
  EXPECT_EQ(eventsOf(heard.front()), Told({"3 END MOVED robot/a|robot/b"})) << "so events 1 and 2 were missed";
}

TEST_F(Events, OfAReloadedRobotEndAndBeginAgainForTheLinksThatRemain) {
  move(0.25, 2, 2);
  node_.setBeside("robot_description", balls({"a"}));
  ASSERT_TRUE(node_.reload("robot").success);
  waitForEvents(5);
  node_.waitForTicks(3);
  Told last = told();
  last.erase(last.begin(), last.begin() + 2);
  EXPECT_EQ(last, Told({"3 END BODIES obstacle/post|robot/a", "4 END BODIES robot/a|robot/b",
                        "5 BEGIN BODIES obstacle/post|robot/a"}));
  const auto message = node_.heard().events.back();
  EXPECT_TRUE(std::isnan(message->gap.at(1))) << "b does not exist any more";
  EXPECT_NEAR(message->gap.at(2), 0.05, 1e-6);
}

TEST_F(Events, BeginAgainInANewEpoch) {
  move(0.25, 2, 2);
  const std::uint64_t before = node_.heard().events.back()->world.epoch;
  ASSERT_TRUE(node_.reset().success);
  waitForEvents(4);
  node_.waitForTicks(3);
  Told last = told();
  last.erase(last.begin(), last.begin() + 2);
  EXPECT_EQ(last, Told({"1 BEGIN EPOCH obstacle/post|robot/a", "2 BEGIN EPOCH robot/a|robot/b"}));
  EXPECT_NE(node_.heard().events.back()->world.epoch, before);
  EXPECT_EQ(node_.heard().pairs.back()->world.last_event, 2u);
}

TEST(EventsOfStaleBodies, SayThatStalenessIsTheirCause) {
  NodeSetup setup;
  setup.params = dict({{"late_after", 0.05},
                       {"stale_after", 0.1},
                       {"growth_cap", 0.5},
                       {"max_speed", list({dict({{"pattern", "robot/*"}, {"speed", 50.0}})})},
                       {"obstacles", list({ball("post", -0.6, 0, 0, 0.1)})}});
  setup.beside["robot_description"] = balls({"a"});
  TransformSource transforms;
  NodeUnderTest node(setup);
  transforms.stream("base", "a", at(0));
  node.waitForComplete();
  const auto lastIs = [&](const std::string& words) {
    node.waitUntil(words, [&](const Heard& heard) {
      return !heard.events.empty() && bool(says(eventsOf(*heard.events.back()).back(), words));
    });
  };
  transforms.stop("a");
  lastIs("BEGIN STALENESS obstacle/post|robot/a");
  transforms.stream("base", "a", at(0));
  lastIs("END STALENESS obstacle/post|robot/a");
}

}  // namespace
}  // namespace test
}  // namespace hgrid
