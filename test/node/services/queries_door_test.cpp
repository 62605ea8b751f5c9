// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#include <hgrid_proximity/BodyState.h>
#include <hgrid_proximity/Verdict.h>

#include <limits>

#include "test/node/support/claims.h"
#include "test/node/support/descriptions.h"
#include "test/node/support/transform_source.h"

namespace hgrid {
namespace test {
namespace {

using msg::Answer;

const double kNan = std::numeric_limits<double>::quiet_NaN();
const double kInfinity = std::numeric_limits<double>::infinity();

/// A complete world with one obstacle "post". A refused query must not change it.
class QueryDoor : public ::testing::Test {
 protected:
  static void SetUpTestSuite() {
    transforms_ = std::make_unique<TransformSource>();
    NodeSetup setup;
    setup.params = dict({{"obstacles", list({ball("post", 2, 0, 0, 0.1)})},
                         {"late_after", 3600.0},
                         {"stale_after", 3600.0},
                         {"lost_after", 3600.0}});
    setup.beside["robot_description"] = balls({"a"});
    node_ = std::make_unique<NodeUnderTest>(setup);
    transforms_->send({stamped("base", "a", at(0), transforms_->now())});
    node_->waitForComplete();
  }
  static void TearDownTestSuite() {
    node_.reset();
    transforms_.reset();
  }
  template <class Response>
  static void expectRefused(const Response& response, const std::string& code, const std::string& words) {
    const Answer& answer = response.answer;
    EXPECT_FALSE(answer.success);
    EXPECT_EQ(answer.code.name, code);
    EXPECT_TRUE(says(answer.code.text, words));
    EXPECT_EQ(answer.verdict, msg::Verdict::UNKNOWN) << "never CLEAR";
    EXPECT_TRUE(answer.hits.empty());
    EXPECT_EQ(answer.total, 0u);
    EXPECT_GT(response.world.sequence, 0u) << "a refusal contains the state of the world as well";
    EXPECT_EQ(namesOf(node_->sphere(2, 0, 0, 0.05).answer), std::vector<std::string>({"obstacle/post"}));
    EXPECT_TRUE(node_->process().alive());
  }
  static std::unique_ptr<TransformSource> transforms_;
  static std::unique_ptr<NodeUnderTest> node_;
};

std::unique_ptr<TransformSource> QueryDoor::transforms_;
std::unique_ptr<NodeUnderTest> QueryDoor::node_;

TEST_F(QueryDoor, AnInvalidRadiusIsRefused) {
  expectRefused(node_->sphere(0, 0, 0, kNan), "BAD_GEOMETRY", "radius is nan m; it must be finite and not negative");
  expectRefused(node_->sphere(0, 0, 0, -1), "BAD_GEOMETRY", "radius is -1 m");
  expectRefused(node_->sphere(0, 0, 0, kInfinity), "BAD_GEOMETRY", "radius is inf m");
  expectRefused(node_->segment(xyz(0, 0, 0), xyz(1, 0, 0), -0.5), "BAD_GEOMETRY", "radius is -0.5 m");
  expectRefused(node_->sphere(0, 0, 0, 1e11), "OUT_OF_RANGE", "it must be at most");
  EXPECT_TRUE(throttled(*node_, "query.refused.BAD_GEOMETRY"));
}

TEST_F(QueryDoor, AnInvalidPointIsRefused) {
  expectRefused(node_->sphere(kNan, 0, 0, 1), "NONFINITE", "the query's center is not finite");
  expectRefused(node_->sphere(0, 0, -kInfinity, 1), "NONFINITE", "the query's center is not finite");
  expectRefused(node_->segment(xyz(kNan, 0, 0), xyz(1, 0, 0), 0), "NONFINITE", "the segment's start");
  expectRefused(node_->segment(xyz(0, 0, 0), xyz(0, kInfinity, 0), 0), "NONFINITE", "the segment's end");
  expectRefused(node_->segment(xyz(0, 0, 0), xyz(1e300, 0, 0), 0), "OUT_OF_RANGE", "the segment's end");
}

TEST_F(QueryDoor, PatternsThatMatchNoBodyAreRefused) {
  const auto ask = [](const std::vector<std::string>& include, const std::vector<std::string>& exclude) {
    msg::QuerySphere::Request request;
    request.center.x = 5.0;
    request.radius = 0.1;
    request.include = include;
    request.exclude = exclude;
    return node_->ask(request);
  };
  expectRefused(ask({"no_such/*"}, {}), "UNKNOWN_ID", "no body matches the glob 'no_such/*' of include");
  expectRefused(ask({"obstacle/post", "obstacle/pots"}, {}), "UNKNOWN_ID",
                "no body matches the glob 'obstacle/pots' of include; similar names are 'obstacle/post'");
  expectRefused(ask({""}, {}), "UNKNOWN_ID", "no body matches the glob ''");
  expectRefused(ask({}, {"*"}), "UNKNOWN_ID", "exclude leaves out all bodies");
  const auto clear = ask({"obstacle/*"}, {"nobody"}).answer;
  EXPECT_EQ(clear.verdict, msg::Verdict::CLEAR);
  EXPECT_EQ(clear.summary, "CLEAR: none of the 1 requested bodies is there");
}

TEST_F(QueryDoor, AMisspelledBodyIsRefusedWithSimilarNames) {
  msg::QuerySphere::Request request;
  request.respect_allowed = true;
  request.as_body = "post";
  expectRefused(node_->ask(request), "UNKNOWN_ID", "there is no body 'post'; similar names are 'obstacle/post'");
}

TEST_F(QueryDoor, AFrameThatNobodyKnowsIsRefused) {
  expectRefused(node_->sphere(0, 0, 0, 1, "nowhere"), "UNKNOWN_FRAME", "frame 'nowhere' is not connected to 'base'");
  expectRefused(node_->sphere(0, 0, 0, 1, "a\n\x1b[31m"), "UNKNOWN_FRAME", "a\\x0a\\x1b[31m");
}

TEST_F(QueryDoor, AStampBeyondTheHistoryOrInTheFutureIsRefused) {
  const ros::Time stamp = node_->heard().status.back()->header.stamp;  // stays the same, because no transform arrives
  msg::QuerySphere::Request request;
  request.center.x = 2;
  request.header.stamp = stamp;
  EXPECT_TRUE(node_->ask(request).answer.success);
  EXPECT_EQ(node_->ask(request).header.stamp, stamp);
  for (const double shift : {-3600.0, 0.001, 3600.0}) {
    SCOPED_TRACE(shift);
    request.header.stamp = stamp + ros::Duration(shift);
    const std::string words =
        shift < 0.0 ? " s before the newest tick; the node " : " s after the newest tick; the node ";
    expectRefused(node_->ask(request), "EXTRAPOLATION", words);
  }
}

TEST_F(QueryDoor, PatternsAreBounded) {
  msg::QuerySphere::Request request;
  request.include.assign(257, "x");
  expectRefused(node_->ask(request), "LIMIT", "257 name patterns; at most 256");
  request.include.clear();
  request.exclude = {std::string(513, 'x')};
  expectRefused(node_->ask(request), "BAD_ID", "has 513 bytes; at most 512");
}

TEST_F(QueryDoor, RefusalsAreCountedExactlyAndLoggedAtMostOnceASecond) {
  const auto total = [](const msg::Status& s) { return counter(s, "query.refused.BAD_GEOMETRY"); };
  node_->sphere(0, 0, 0, -1);
  node_->waitForTicks(2);
  const auto before = total(*node_->heard().status.back());
  for (int i = 0; i < 300; ++i) node_->sphere(0, 0, 0, -1);
  node_->waitForStatus("all refusals are counted", [&](const msg::Status& s) { return total(s) == before + 300; });
  node_->waitForTicks(2);
  EXPECT_EQ(total(*node_->heard().status.back()), before + 300);
  EXPECT_TRUE(throttled(*node_, "query.refused.BAD_GEOMETRY"));
}

TEST(QueryBeforeTheWorld, IsNotReadyAndNeverClear) {
  NodeUnderTest node(NodeSetup{});  // without a robot there is no world frame
  node.waitForStatus("the missing robot description is reported", [](const msg::Status& s) {
    return says(s.not_ready.at(0), "parameter 'robot_description' is not set");
  });
  for (const Answer& answer : {node.sphere(0, 0, 0, 1).answer, node.segment(xyz(0, 0, 0), xyz(1, 0, 0), 0).answer}) {
    EXPECT_FALSE(answer.success);
    EXPECT_EQ(answer.code.name, "NOT_READY");
    EXPECT_TRUE(says(answer.code.text, "there is no world yet"));
    EXPECT_TRUE(says(answer.code.text, "robot_description"));
    EXPECT_EQ(answer.verdict, msg::Verdict::UNKNOWN);
    EXPECT_TRUE(answer.hits.empty());
  }
  const auto response = node.sphere(0, 0, 0, 1);
  EXPECT_EQ(response.world.sequence, 0u);
  EXPECT_FALSE(response.world.complete);
  EXPECT_EQ(response.world.worst_state, msg::BodyState::UNPLACED);
}

}  // namespace
}  // namespace test
}  // namespace hgrid
