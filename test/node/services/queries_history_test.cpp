// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#include <hgrid_proximity/Verdict.h>

#include "test/node/support/claims.h"
#include "test/node/support/descriptions.h"
#include "test/node/support/transform_source.h"

namespace hgrid {
namespace test {
namespace {

/// A robot whose link "a" is a sphere of 0.1 m. The link jumps from x = 1 m to x = 5 m. An obstacle "post" is at x = 1
/// m.
class QueryHistory : public ::testing::Test {
 protected:
  QueryHistory() {
    NodeSetup setup;
    setup.params = dict({{"obstacles", list({ball("post", 1, 0.25, 0, 0.1)})},
                         {"history", 60.0},
                         {"valid_for", 0.05},  // one period of ~heartbeat
                         {"late_after", 3600.0},
                         {"stale_after", 3600.0},
                         {"lost_after", 3600.0}});
    setup.beside["robot_description"] = balls({"a"});
    node_ = std::make_unique<NodeUnderTest>(setup);
    // Before the first transform arrives, each tick has the ROS time at which it is made. That can be later than the
    // stamp of the first transform, and then no tick ever has this stamp. So moveTo() only sends transforms that are
    // stamped after the world is complete.
    transforms_.send({stamped("base", "a", at(1.0), transforms_.now())});
    node_->waitForComplete();
    before_ = moveTo(1.0);
    after_ = moveTo(5.0);
  }
  /// Moves the link. @returns the stamp of a tick that has it there
  ros::Time moveTo(double x) {
    const ros::Time stamp = transforms_.now();
    transforms_.send({stamped("base", "a", at(x), stamp)});
    return node_
        ->waitForStatus(
            "a tick of the move",
            [&](const msg::Status& status) { return status.header.stamp == stamp && status.world.complete; })
        ->header.stamp;
  }
  msg::QuerySphere::Response sphere(double x, double radius, ros::Time stamp, const std::string& frame = "") {
    msg::QuerySphere::Request request;
    request.center.x = x;
    request.radius = radius;
    request.header.stamp = stamp;
    request.header.frame_id = frame;
    request.include = {"robot/*"};
    return node_->ask(request);
  }

  TransformSource transforms_;
  std::unique_ptr<NodeUnderTest> node_;
  ros::Time before_, after_;
};

TEST_F(QueryHistory, QueriesAndExplanationsAnswerForTheTimeOfTheirStamp) {
  const auto past = sphere(1.0, 0.05, before_);
  EXPECT_EQ(namesOf(past.answer), std::vector<std::string>({"robot/a"}));
  EXPECT_EQ(past.header.stamp, before_);
  EXPECT_EQ(past.world.stamp, before_);
  EXPECT_LE(past.world.history_begin, before_);
  EXPECT_TRUE(says(past.answer.summary, "HIT: 1 body, first robot/a (at the tick of "));
  EXPECT_TRUE(says(past.answer.summary, " s before the newest tick)"));
  EXPECT_EQ(namesOf(sphere(5.0, 0.05, after_).answer), std::vector<std::string>({"robot/a"}));
  EXPECT_LT(past.world.sequence, sphere(5.0, 0.05, after_).world.sequence);
  const auto between = sphere(1.0, 0.05, before_ + ros::Duration(1e-9));
  EXPECT_EQ(between.header.stamp, before_) << "the last tick that is not later";

  EXPECT_TRUE(node_->explain("robot/a", "obstacle/post", 0, before_).reported);
  EXPECT_FALSE(node_->explain("robot/a", "obstacle/post", 0, after_).reported);
  EXPECT_FALSE(node_->explain("robot/a", "obstacle/post").reported);
  EXPECT_TRUE(says(node_->explain("robot/a", "obstacle/post", 0, before_).explanation, "This was so at the tick of "));

  node_->waitForTicks(4);  // the past tick is now older than ~valid_for, which does not apply to a named time
  EXPECT_EQ(sphere(5.0, 0.05, before_).answer.verdict, msg::Verdict::CLEAR);

  const auto own = sphere(0.0, 0.05, before_, "a");  // the frame is where it was then
  EXPECT_EQ(namesOf(own.answer), std::vector<std::string>({"robot/a"}));
  EXPECT_EQ(own.header.frame_id, "a");
  ASSERT_EQ(own.answer.hits.size(), 1u);
  EXPECT_NEAR(own.answer.hits[0].point.x, 0.0, 1e-6);

  for (const double shift : {-3600.0, 3600.0}) {
    const auto refused = sphere(1.0, 0.05, after_ + ros::Duration(shift));
    EXPECT_EQ(refused.answer.code.name, "EXTRAPOLATION");
    EXPECT_TRUE(says(refused.answer.code.text, "the node can answer about "));
  }
  EXPECT_EQ(node_->explain("robot/a", "obstacle/post", 0, ros::Time(1.0)).code.name, "EXTRAPOLATION");

  node_->reset();  // begins a new epoch
  const auto forgotten = sphere(1.0, 0.05, before_);
  EXPECT_EQ(forgotten.answer.code.name, "EXTRAPOLATION");
  EXPECT_TRUE(node_->process().alive());
}

}  // namespace
}  // namespace test
}  // namespace hgrid
