// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#include <hgrid_proximity/QueryNearest.h>
#include <hgrid_proximity/Verdict.h>
#include <ros/service.h>

#include "test/node/support/claims.h"
#include "test/node/support/descriptions.h"
#include "test/node/support/transform_source.h"

namespace hgrid {
namespace test {
namespace {

using msg::Answer;

/// Four spherical obstacles at x = 2, 3, 4 and 5 m, and one that follows a tf frame rotated by 90 degrees.
class QueryAnswers : public ::testing::Test {
 protected:
  static void SetUpTestSuite() {
    transforms_ = std::make_unique<TransformSource>();
    transforms_->fix({stamped("world", "turned", at(1, 2, 3, 1.5707963267948966))});
    NodeSetup setup;
    setup.params = dict(
        {{"world_frame", "world"},
         {"robots", list({dict({{"name", "none"}, {"description", "robot_description"}})})},
         {"accept_uncovered", list({waiver("none/*", "there is no robot")})},
         {"obstacles", list({ball("post_5", 5, 0, 0, 0.1), ball("post_3", 3, 0, 0, 0.1), ball("post_2", 2, 0, 0, 0.1),
                             ball("post_4", 4, 0, 0, 0.1), ball("turned", 1, 0, 0, 0.1, "turned")})}});
    setup.beside["robot_description"] = urdf(link("world"));
    node_ = std::make_unique<NodeUnderTest>(setup);
    node_->waitForComplete();
  }
  static void TearDownTestSuite() {
    node_.reset();
    transforms_.reset();
  }
  static std::unique_ptr<TransformSource> transforms_;
  static std::unique_ptr<NodeUnderTest> node_;
};

std::unique_ptr<TransformSource> QueryAnswers::transforms_;
std::unique_ptr<NodeUnderTest> QueryAnswers::node_;

TEST_F(QueryAnswers, ASphereHitsBodiesSortedByDistanceThenCenterDistance) {
  const auto response = node_->sphere(3.2, 0, 0, 1.0);
  const Answer& answer = response.answer;
  EXPECT_TRUE(answer.success);
  EXPECT_EQ(answer.code.name, "OK");
  EXPECT_EQ(answer.verdict, msg::Verdict::HIT);
  EXPECT_EQ(namesOf(answer), std::vector<std::string>({"obstacle/post_3", "obstacle/post_4"}));
  EXPECT_EQ(answer.total, 2u);
  EXPECT_FALSE(answer.truncated);
  EXPECT_TRUE(says(answer.summary, "HIT: 2 bodies"));
  EXPECT_EQ(answer.hits[0].distance, 0.0);
  EXPECT_NEAR(answer.hits[0].center_distance, 0.1, 1e-6);
  EXPECT_NEAR(answer.hits[1].center_distance, 0.7, 1e-6);
  EXPECT_NEAR(answer.hits[1].point.x, 3.9, 1e-6);
  EXPECT_TRUE(std::isnan(answer.hits[0].along));
  EXPECT_TRUE(std::isnan(answer.hits[0].normal.x));
  EXPECT_EQ(answer.hits[0].shape, 0u);
  EXPECT_EQ(response.header.frame_id, "world");
  EXPECT_EQ(response.header.stamp, response.world.stamp);
  EXPECT_TRUE(response.world.complete);
}

TEST_F(QueryAnswers, ASegmentHitsBodiesInOrderAlongIt) {
  const auto forth = node_->segment(xyz(0, 0, 0), xyz(9, 0, 0), 0.0).answer;
  EXPECT_EQ(namesOf(forth),
            std::vector<std::string>({"obstacle/post_2", "obstacle/post_3", "obstacle/post_4", "obstacle/post_5"}));
  EXPECT_NEAR(forth.hits[0].along, 1.9, 1e-6);
  const auto back = node_->segment(xyz(9, 0, 0), xyz(0, 0, 0), 0.0).answer;
  EXPECT_EQ(namesOf(back),
            std::vector<std::string>({"obstacle/post_5", "obstacle/post_4", "obstacle/post_3", "obstacle/post_2"}));
  EXPECT_NEAR(back.hits[0].along, 3.9, 1e-6);
  const auto beside = node_->segment(xyz(0, 0.3, 0), xyz(9, 0.3, 0), 0.0).answer;
  EXPECT_EQ(beside.verdict, msg::Verdict::CLEAR);
  EXPECT_EQ(beside.summary, "CLEAR: nothing is there");
  EXPECT_EQ(node_->segment(xyz(0, 0.3, 0), xyz(9, 0.3, 0), 0.25).answer.total, 4u);
}

TEST_F(QueryAnswers, TheSummaryOfANearestBodySaysWhichOneAndHowFar) {
  msg::QueryNearest query;
  const auto summary = [&query] {
    EXPECT_TRUE(ros::service::call(node_->named("query_nearest"), query));
    return query.response.answer.summary;
  };
  query.request.point.x = 2.35;
  query.request.include = {"obstacle/post_*"};
  EXPECT_EQ(summary(), "NEAREST: obstacle/post_2 at 0.25 m (1 body listed)");
  query.request.limit = 3;
  EXPECT_EQ(summary(), "NEAREST: obstacle/post_2 at 0.25 m (3 bodies listed)");
  query.request.point.x = 2.05;
  EXPECT_EQ(summary(), "NEAREST: obstacle/post_2 at 0 m (3 bodies listed)");
  query.request.point.x = 7;
  query.request.max_distance = 0.5;
  EXPECT_EQ(summary(), "CLEAR: none of the 4 requested bodies is within 0.5 m");
  query.request.include.clear();
  EXPECT_EQ(summary(), "CLEAR: nothing is within 0.5 m");
  query.request.include = {"obstacle/nobody"};
  EXPECT_TRUE(says(summary(), "UNKNOWN, because the query was refused: "));
}

TEST_F(QueryAnswers, ARadiusOf0MakesAPointAndEqualEndsMakeASphere) {
  EXPECT_EQ(namesOf(node_->sphere(2.05, 0, 0, 0.0).answer), std::vector<std::string>({"obstacle/post_2"}));
  EXPECT_EQ(node_->sphere(2.2, 0, 0, 0.0).answer.verdict, msg::Verdict::CLEAR);
  EXPECT_EQ(namesOf(node_->segment(xyz(2.2, 0, 0), xyz(2.2, 0, 0), 0.15).answer),
            std::vector<std::string>({"obstacle/post_2"}));
  EXPECT_EQ(node_->segment(xyz(2.2, 0, 0), xyz(2.2, 0, 0), 0.05).answer.verdict, msg::Verdict::CLEAR);
}

TEST_F(QueryAnswers, ASegmentMayBeAMillionKilometersLong) {
  const auto answer = node_->segment(xyz(-1e9, 0, 0), xyz(1e9, 0, 0), 0.0).answer;
  EXPECT_TRUE(answer.success);
  EXPECT_EQ(answer.total, 4u);
  EXPECT_EQ(node_->sphere(0, 0, 0, 1e9).answer.total, 5u);
}

TEST_F(QueryAnswers, ALimitCutsAndSaysSo) {
  msg::QuerySegment::Request request;
  request.end.x = 9;
  request.limit = 3;
  auto answer = node_->ask(request).answer;
  EXPECT_EQ(namesOf(answer), std::vector<std::string>({"obstacle/post_2", "obstacle/post_3", "obstacle/post_4"}));
  EXPECT_EQ(answer.total, 4u);
  EXPECT_TRUE(answer.truncated);
  request.limit = 4;
  EXPECT_FALSE(node_->ask(request).answer.truncated);
}

TEST_F(QueryAnswers, PatternsSelectBodiesAndExcludeTakesPrecedenceOverInclude) {
  msg::QuerySphere::Request request;
  request.radius = 100;
  request.include = {"obstacle/post_*"};
  request.exclude = {"*_3", "*_5"};
  EXPECT_EQ(namesOf(node_->ask(request).answer), std::vector<std::string>({"obstacle/post_2", "obstacle/post_4"}));
  request.include = {"obstacle/post_4"};
  request.center.x = 1e3;
  EXPECT_EQ(node_->ask(request).answer.verdict, msg::Verdict::CLEAR) << "the only body asked about is far away";
}

TEST_F(QueryAnswers, AQuestionInATurnedFrameIsAnsweredInIt) {
  // The x axis of the frame is the y axis of the world. The obstacle is at (1, 0, 0) in the frame, which is (1, 3, 3)
  // in the world.
  const auto there = node_->sphere(1, 0, 0, 0.05, "turned");
  EXPECT_EQ(namesOf(there.answer), std::vector<std::string>({"obstacle/turned"}));
  EXPECT_EQ(namesOf(node_->sphere(1, 3, 3, 0.05).answer), std::vector<std::string>({"obstacle/turned"}));
  EXPECT_EQ(there.header.frame_id, "turned");
  const auto row = node_->segment(xyz(-2, 2, -3), xyz(-2, -9, -3), 0.0, "turned");  // along the x axis of the world
  EXPECT_EQ(namesOf(row.answer),
            std::vector<std::string>({"obstacle/post_2", "obstacle/post_3", "obstacle/post_4", "obstacle/post_5"}));
  EXPECT_NEAR(row.answer.hits[0].along, 2.9, 1e-6);
  EXPECT_NEAR(row.answer.hits[0].point.x, -2.0, 1e-6);
  EXPECT_NEAR(row.answer.hits[0].point.y, -0.9, 1e-6) << "the point is (1.9, 0, 0) in the world";
  EXPECT_NEAR(row.answer.hits[0].point.z, -3.0, 1e-6);
}

TEST_F(QueryAnswers, ALeadingSlashIsTakenOffAFramesName) {
  const auto response = node_->sphere(1, 0, 0, 0.05, "/turned");
  EXPECT_EQ(namesOf(response.answer), std::vector<std::string>({"obstacle/turned"}));
  EXPECT_EQ(response.header.frame_id, "turned");
  EXPECT_EQ(node_->sphere(2, 0, 0, 0.05, "/world").answer.total, 1u);
}

TEST(QueryLimits, MaxHitsBoundsEveryAnswer) {
  NodeSetup setup;
  setup.params =
      dict({{"world_frame", "base"},
            {"limits/max_hits", 2},
            {"obstacles", list({ball("a", 0, 0, 0, 0.1), ball("b", 1, 0, 0, 0.1), ball("c", 2, 0, 0, 0.1)})}});
  setup.beside["robot_description"] = balls({});
  NodeUnderTest node(setup);
  node.waitForComplete();
  msg::QuerySphere::Request request;
  request.radius = 3;
  request.limit = 100;
  for (const std::uint32_t limit : {0u, 100u}) {
    request.limit = limit;
    const auto answer = node.ask(request).answer;
    EXPECT_EQ(answer.hits.size(), 2u);
    EXPECT_EQ(answer.total, 3u);
    EXPECT_TRUE(answer.truncated);
  }
}

}  // namespace
}  // namespace test
}  // namespace hgrid
