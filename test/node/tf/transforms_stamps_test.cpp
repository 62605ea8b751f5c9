// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#include <hgrid_proximity/BodyState.h>

#include "test/node/support/claims.h"
#include "test/node/support/descriptions.h"
#include "test/node/support/transform_source.h"

namespace hgrid {
namespace test {
namespace {

/// Returns a setup with age limits that are so long that no pose becomes LATE.
NodeSetup ageless() {
  NodeSetup setup;
  setup.params = dict({{"stale_after", 3600.0},
                       {"lost_after", 3600.0},
                       {"late_after", 3600.0},
                       {"limits/max_sync_wait", 0.1},
                       {"limits/max_future", 1.5}});
  setup.beside["robot_description"] = balls({"a", "b", "c"});
  return setup;
}

/// Tests that send single transforms of the frames a, b and c, with chosen stamps.
class Stamps : public ::testing::Test {
 protected:
  Stamps() : node_(ageless()) {
    node_.waitForStatus("the robot", [](const msg::Status& s) { return s.body_count == 4; });
    begin_ = transforms_.now() + ros::Duration(0.9);
  }
  geometry_msgs::TransformStamped frame(const std::string& child, double x, double after) const {
    return stamped("base", child, at(x), begin_ + ros::Duration(after));
  }
  /// Sends transforms. Waits until the node has read them and has made a tick after their stamps.
  msg::Status::ConstPtr take(const std::vector<geometry_msgs::TransformStamped>& transforms) {
    transforms_.send(transforms);
    for (const auto& transform : transforms) {
      const ros::Time stamp = transform.header.stamp;
      if (stamp < transforms_.now() + ros::Duration(1.5)) newest_ = std::max(newest_, stamp);
    }
    node_.waitForTransforms(transforms_.sent());
    return node_.waitForStatus("a tick after the stamps", [&](const msg::Status& s) { return s.made > newest_; });
  }
  /// Returns the time [s] from begin_ to `time`.
  double after(const ros::Time& time) const { return (time - begin_).toSec(); }

  TransformSource transforms_;
  NodeUnderTest node_;
  ros::Time begin_;   // in the future, because until a frame moves, ticks use the current time, and their time never
                      // goes back
  ros::Time newest_;  // newest stamp that was sent; stamps that are refused do not count
};

TEST_F(Stamps, TheTimeOfTheWorldIsTheNewestThatAllFreshFramesHave) {
  take({frame("a", 0.0, 0.1), frame("b", 5.0, 0.1), frame("c", 9.0, 0.1)});
  auto status = take({frame("a", 0.1, 0.2), frame("b", 5.0, 0.2), frame("c", 9.0, 0.15)});
  EXPECT_NEAR(after(status->header.stamp), 0.15, 1e-6) << "the tick waits for c";
  EXPECT_EQ(status->header.stamp, status->world.stamp);
  EXPECT_NEAR(xOf(node_, "robot/a"), 0.05, 1e-5) << "the pose of a is interpolated at that time";

  status = take({frame("c", 9.0, 0.2)});
  EXPECT_NEAR(after(status->header.stamp), 0.2, 1e-6);
  EXPECT_NEAR(xOf(node_, "robot/a"), 0.1, 1e-5);
}

TEST_F(Stamps, ALaggardKeepsItsOwnStampAndHoldsNobodyBack) {
  take({frame("a", 0.0, 0.1), frame("b", 5.0, 0.1), frame("c", 9.0, 0.1)});
  auto status = take({frame("a", 1.0, 0.4), frame("b", 5.0, 0.4)});
  EXPECT_NEAR(after(status->header.stamp), 0.4, 1e-6);
  EXPECT_NEAR(xOf(node_, "robot/a"), 1.0, 1e-5);
  ASSERT_NE(entryOf(*status, "robot/c"), nullptr);
  EXPECT_EQ(stateOf(*status, "robot/c"), msg::BodyState::LATE);
  EXPECT_NEAR(after(entryOf(*status, "robot/c")->stamp), 0.1, 1e-6);
  EXPECT_NEAR(xOf(node_, "robot/c"), 9.0, 1e-5);
  EXPECT_TRUE(status->world.complete);

  status = take({frame("c", 8.0, 0.35)});
  EXPECT_NEAR(after(status->header.stamp), 0.4, 1e-6) << "the time of ticks does not run back when c catches up";
  EXPECT_EQ(stateOf(*status, "robot/c"), msg::BodyState::LATE);
  EXPECT_NEAR(after(entryOf(*status, "robot/c")->stamp), 0.35, 1e-6);
  EXPECT_NEAR(xOf(node_, "robot/c"), 8.0, 1e-5);

  status = take({frame("c", 7.0, 0.4)});
  EXPECT_EQ(status->bodies_total, 0u);
}

TEST_F(Stamps, ATransformFromTheFutureIsRefusedAndDoesNotPoisonItsFrame) {
  for (const double ahead : {2.0, 1e9}) {
    SCOPED_TRACE(ahead);
    const auto send = [&](double x) {
      const ros::Time now = transforms_.now();
      return take(
          {stamped("base", "a", at(x), now), stamped("base", "b", at(5), now), stamped("base", "c", at(9), now)});
    };
    send(0.0);
    auto status = take({stamped("base", "a", at(3), transforms_.now() + ros::Duration(ahead))});
    ASSERT_NE(entryOf(*status, "robot/a"), nullptr);
    EXPECT_EQ(entryOf(*status, "robot/a")->code.name, "CLOCK");
    EXPECT_TRUE(says(entryOf(*status, "robot/a")->code.text, "frame 'a' is stamped"));
    EXPECT_TRUE(says(entryOf(*status, "robot/a")->code.text, "s in the future; at most 1.5 s are allowed"));
    EXPECT_EQ(stateOf(*status, "robot/a"), msg::BodyState::INVALID);
    EXPECT_NEAR(xOf(node_, "robot/a"), 0.0, 1e-6);
    status = send(1.0);
    EXPECT_TRUE(status->world.complete);
    EXPECT_NEAR(xOf(node_, "robot/a"), 1.0, 1e-6);
  }
  EXPECT_TRUE(throttled(node_, "tf.refused.CLOCK"));
}

TEST_F(Stamps, AStampThatComesAgainWithAnotherPoseIsIgnoredAndCounted) {
  take({frame("a", 0.0, 0.1), frame("b", 5.0, 0.1), frame("c", 9.0, 0.1)});
  transforms_.send({frame("a", 0.0, 0.1)});  // equal to the one before: this is a repetition
  for (int i = 0; i < 100; ++i) transforms_.send({frame("a", 1.0, 0.1)});
  const auto status = node_.waitForStatus("all repeated stamps are counted",
                                          [](const msg::Status& s) { return counter(s, "tf.ignored.DUP_ID") == 100; });
  EXPECT_TRUE(status->world.complete);
  EXPECT_EQ(counter(*status, "tf.repeated"), 1u);
  EXPECT_NEAR(xOf(node_, "robot/a"), 0.0, 1e-6) << "the first pose is kept";
  EXPECT_TRUE(throttled(node_, "tf.ignored.DUP_ID"));
  EXPECT_TRUE(says(node_.output(), "frame 'a' was sent twice with stamp"));
}

TEST_F(Stamps, OfTransformsOutOfOrderTheNewestCounts) {
  take({frame("a", 0.0, 0.1), frame("b", 5.0, 0.1), frame("c", 9.0, 0.1)});
  take({frame("a", 0.2, 0.2), frame("b", 5.0, 0.2), frame("c", 9.0, 0.2)});
  const auto status = take({frame("a", 0.15, 0.15)});  // 50 ms older than the newest stamp
  EXPECT_NEAR(after(status->header.stamp), 0.2, 1e-6);
  EXPECT_NEAR(xOf(node_, "robot/a"), 0.2, 1e-5);
  EXPECT_EQ(counter(*status, "tf.out_of_order"), 1u);
  EXPECT_EQ(status->bodies_total, 0u);
}

TEST_F(Stamps, OldTransformsDoNotFloodTheLog) {
  take({frame("a", 0.0, 0.1), frame("b", 5.0, 0.1), frame("c", 9.0, 0.1)});
  const std::size_t before = node_.lines("");
  for (int i = 0; i < 200; ++i) transforms_.send({frame("a", 1.0, -3000.0 + 0.001 * i)});
  const auto status = node_.waitForTransforms(transforms_.sent());
  EXPECT_EQ(counter(*status, "tf.too_old"), 200u);
  EXPECT_NEAR(xOf(node_, "robot/a"), 0.0, 1e-6);
  EXPECT_LE(node_.lines("") - before, 3u + static_cast<std::size_t>(node_.uptime()));
}

TEST_F(Stamps, StampsThatComeAgainLaterDoNotFloodTheLog) {
  take({frame("a", 0.0, 0.1), frame("b", 5.0, 0.1), frame("c", 9.0, 0.1)});
  take({frame("a", 0.1, 0.2)});
  const std::size_t before = node_.lines("");
  for (int i = 0; i < 200; ++i) transforms_.send({frame("a", 0.0, 0.1)});
  take({frame("a", 0.3, 0.3)});
  EXPECT_LE(node_.lines("") - before, 3u + static_cast<std::size_t>(node_.uptime()));
}

TEST(TimeOfTheWorld, NeverRunsBackWithinAnEpoch) {
  TransformSource transforms;
  NodeUnderTest node(ageless());
  node.waitForTicks(5);  // no frame has moved so far
  transforms.stream("base", "a", at(0), 0.3);
  transforms.stream("base", "b", at(5), 0.25);
  transforms.stream("base", "c", at(9), 0.0);
  node.waitForComplete();
  node.waitForTicks(10);
  transforms.stop("c");
  node.waitForTicks(30);
  transforms.stop("b");
  transforms.stop("a");
  transforms.stream("base", "c", at(9), 0.4);
  node.waitForTicks(30);
  const Heard all = node.heard();
  for (std::size_t i = 1; i < all.pairs.size(); ++i) {
    const msg::Pairs &last = *all.pairs[i - 1], &next = *all.pairs[i];
    if (last.world.sequence == 0) continue;  // there was no world so far
    ASSERT_EQ(last.world.epoch, next.world.epoch);
    ASSERT_GT(next.world.sequence, last.world.sequence);
    ASSERT_GE(next.header.stamp, last.header.stamp) << "tick " << next.world.sequence;
  }
}

}  // namespace
}  // namespace test
}  // namespace hgrid
