// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#include <hgrid_proximity/AllowedPair.h>
#include <hgrid_proximity/BodyState.h>
#include <hgrid_proximity/Distances.h>
#include <hgrid_proximity/MeasureStatus.h>
#include <hgrid_proximity/RuleOrigin.h>

#include "test/node/support/claims.h"
#include "test/node/support/descriptions.h"
#include "test/node/support/transform_source.h"

namespace hgrid {
namespace test {
namespace {

/// A robot of spheres that all overlap, except the spheres "far" and "ghost". Nobody publishes a transform for "ghost".
/// A fixed joint connects "c" with "b".
class ExplainPair : public ::testing::Test {
 protected:
  static void SetUpTestSuite() {
    transforms_ = std::make_unique<TransformSource>();
    NodeSetup setup;
    setup.params =
        dict({{"obstacles", list({ball("post", 0, 0.1, 0, 0.1), ball("wall", 0, 0.1, 0, 0.1)})},
              {"late_after", 0.2},
              {"stale_after", 0.5},
              {"lost_after", 3600.0},
              {"default_max_speed", 0.1},
              {"growth_cap", 0.05},
              {"margins", list({dict({{"pattern", "robot/d"}, {"margin", 0.3}})})},
              {"allowed_pairs",
               list({dict({{"first", "robot/a"}, {"second", "obstacle/w*"}, {"reason", "it leans there"}})})}});
    std::string content = link("base", sphereOf(0.1, "0 0 -5"));
    for (const char* name : {"a", "b", "d", "far", "ghost"}) {
      content += link(name, sphereOf(0.1)) + joint("base", name);
    }
    content += link("c", sphereOf(0.1)) + joint("b", "c", "fixed");
    setup.beside["robot_description"] = urdf(content);
    setup.beside["robot_description_semantic"] =
        std::string("<robot name=\"r\"><disable_collisions link1=\"a\" link2=\"b\" reason=\"Never\"/></robot>");
    for (const char* name : {"a", "b", "d"}) transforms_->stream("base", name, at(0));
    transforms_->stream("base", "far", at(2));
    node_ = std::make_unique<NodeUnderTest>(setup);
    node_->waitForStatus("all bodies except robot/ghost are placed", [](const msg::Status& status) {
      return status.body_count == 9 && status.bodies_total == 1 &&
             stateOf(status, "robot/ghost") == msg::BodyState::UNPLACED;
    });
  }
  static void TearDownTestSuite() {
    node_.reset();
    transforms_.reset();
  }
  static msg::ExplainPair::Response explained(const std::string& first, const std::string& second) {
    const auto response = node_->explain(first, second);
    EXPECT_TRUE(response.success) << response.code.text;
    EXPECT_EQ(response.header.frame_id, "base");
    EXPECT_EQ(response.header.stamp, response.world.stamp);
    EXPECT_TRUE(std::isnan(response.margin_pair));
    const bool measured = response.state_first != msg::BodyState::UNPLACED &&
                          response.state_second != msg::BodyState::UNPLACED && first != second;
    EXPECT_EQ(response.narrow_status != msg::MeasureStatus::NOT_MEASURED, measured);
    EXPECT_EQ(std::isnan(response.distance), !measured);
    return response;
  }
  static void expectOff(const std::string& first, const std::string& second, int origin, const std::string& words) {
    const auto response = explained(first, second);
    EXPECT_FALSE(response.reported);
    EXPECT_EQ(response.rule.origin, origin);
    EXPECT_TRUE(response.rule.allowed);
    EXPECT_TRUE(says(response.explanation, words));
    EXPECT_TRUE(response.since.isZero());
  }
  static std::unique_ptr<TransformSource> transforms_;
  static std::unique_ptr<NodeUnderTest> node_;
};

std::unique_ptr<TransformSource> ExplainPair::transforms_;
std::unique_ptr<NodeUnderTest> ExplainPair::node_;

TEST_F(ExplainPair, NamesTheReasonOfWhatIsSwitchedOff) {
  expectOff("robot/a", "robot/a", msg::RuleOrigin::SELF, "they are the same body");
  expectOff("obstacle/post", "obstacle/wall", msg::RuleOrigin::KIND, "both are fixed in the world");
  expectOff("robot/b", "robot/c", msg::RuleOrigin::RIGID, "both links are of one rigid group");
  expectOff("robot/base", "robot/a", msg::RuleOrigin::ADJACENT, "joint 'base_a' connects them");
  expectOff("robot/b", "robot/a", msg::RuleOrigin::SRDF, "the SRDF disables the pair (Never)");
  expectOff("obstacle/wall", "robot/a", msg::RuleOrigin::PARAMETER,
            "rule 'robot/a', 'obstacle/w*' of ~allowed_pairs allows them to touch (it leans there)");
}

TEST_F(ExplainPair, NamesTheRuleOfAService) {
  msg::SetAllowed::Request request;
  request.rules.resize(1);
  request.rules[0].first = "obstacle/*";
  request.rules[0].second = "robot/b";
  request.rules[0].allowed = true;
  request.rules[0].reason = "being loaded";
  request.rules[0].lifetime = ros::Duration(3600);
  ASSERT_TRUE(node_->setAllowed(request).success);
  expectOff("robot/b", "obstacle/post", msg::RuleOrigin::SERVICE,
            "rule 'obstacle/*', 'robot/b' of ~set_allowed, which ends in 35");
  const auto response = explained("robot/b", "obstacle/post");
  EXPECT_TRUE(
      says(response.explanation, "(being loaded). Otherwise they would be reported: their boxes touch or overlap"));
  EXPECT_EQ(response.rule.first, "obstacle/*");
  EXPECT_EQ(response.rule.reason, "being loaded");
  EXPECT_GT(response.rule.lifetime.toSec(), 3500.0);
  request.remove = true;
  ASSERT_TRUE(node_->setAllowed(request).success);
  EXPECT_TRUE(explained("robot/b", "obstacle/post").reported);
}

TEST_F(ExplainPair, WhatIsReportedHasTheNumbersOfThePair) {
  const auto response = explained("robot/d", "robot/a");
  EXPECT_TRUE(response.reported);
  EXPECT_EQ(response.rule.origin, msg::RuleOrigin::NONE);
  EXPECT_TRUE(says(response.explanation, "robot/d and robot/a are reported: their boxes touch or overlap"));
  EXPECT_EQ(response.gap, 0.0);
  EXPECT_EQ(response.margin, 0.3);
  EXPECT_EQ(response.margin_first, 0.3);
  EXPECT_EQ(response.margin_second, 0.1);
  EXPECT_EQ(response.growth, 0.0);
  const msg::Pairs pairs = *node_->heard().pairs.back();
  const int index = indexOf(pairs, "robot/a", "robot/d");
  ASSERT_GE(index, 0);
  EXPECT_EQ(response.since, pairs.since[static_cast<std::size_t>(index)]);
  EXPECT_EQ(explained("robot/a", "obstacle/post").age_second, 0.0) << "a fixed body does not age";
  EXPECT_GT(explained("robot/a", "obstacle/post").age_first, 0.0);
}

TEST_F(ExplainPair, WhatIsFarSaysHowFar) {
  const auto response = explained("robot/far", "robot/a");
  EXPECT_FALSE(response.reported);
  EXPECT_EQ(response.rule.origin, msg::RuleOrigin::NONE);
  EXPECT_NEAR(response.gap, 1.8, 1e-6);
  EXPECT_TRUE(says(response.explanation, "their boxes are 1.8 m apart, more than the margin of 0.1 m"));
}

TEST_F(ExplainPair, WhatWasNeverPlacedSaysSo) {
  const auto response = explained("robot/a", "robot/ghost");
  EXPECT_FALSE(response.reported);
  EXPECT_TRUE(std::isnan(response.gap));
  EXPECT_TRUE(std::isnan(response.age_second));
  EXPECT_EQ(response.state_second, msg::BodyState::UNPLACED);
  EXPECT_TRUE(says(response.explanation, "robot/ghost is UNPLACED: it never had a pose (frame 'ghost')"));
}

TEST_F(ExplainPair, WhatIsStaleSaysHowOldAndWhatThatDoes) {
  transforms_->stop("d");
  node_->waitForStatus("d is STALE and its growth is at the cap", [](const msg::Status& status) {
    const auto* d = entryOf(status, "robot/d");
    return d != nullptr && d->state == msg::BodyState::STALE && d->age > 0.6;
  });
  const auto response = explained("robot/d", "obstacle/post");
  EXPECT_TRUE(response.reported);
  EXPECT_EQ(response.state_first, msg::BodyState::STALE);
  EXPECT_EQ(response.state_second, msg::BodyState::FRESH);
  EXPECT_GT(response.age_first, 0.6);
  EXPECT_DOUBLE_EQ(response.growth, 0.05);
  EXPECT_DOUBLE_EQ(response.margin, 0.35);
  EXPECT_TRUE(says(
      response.explanation,
      "The margin is 0.05 m larger than usual because data is old or comes rarely. robot/d is STALE: its pose is"));
  transforms_->stream("base", "d", at(0));
  node_->waitForStatus("d is FRESH", [](const msg::Status& status) { return entryOf(status, "robot/d") == nullptr; });
}

TEST_F(ExplainPair, ListsPlacesOfContactOnRequest) {
  EXPECT_TRUE(node_->explain("robot/d", "obstacle/post").contact_point.empty()) << "none were asked for";
  const auto response = node_->explain("robot/d", "obstacle/post", 3);
  EXPECT_EQ(response.narrow_status, msg::MeasureStatus::CONTACT);
  ASSERT_EQ(response.contact_point.size(), 1u) << "two spheres have one place of contact";
  EXPECT_NEAR(response.contact_point[0].y, 0.05, 1e-6);
  EXPECT_NEAR(response.contact_normal.at(0).y, 1.0, 1e-6) << "the normal points from the first body to the second";
  EXPECT_NEAR(response.contact_depth.at(0), 0.1, 1e-6);
  EXPECT_EQ(response.contact_first_shape.at(0), 0u);
  EXPECT_EQ(response.contact_second_shape.at(0), 0u);
  EXPECT_FALSE(response.contacts_truncated);
  EXPECT_TRUE(node_->explain("robot/d", "robot/far", 3).contact_point.empty()) << "the bodies do not touch";
  EXPECT_TRUE(node_->explain("robot/d", "robot/ghost", 3).contact_point.empty()) << "ghost has no pose";
}

TEST_F(ExplainPair, NamesThatNobodyHasAreRefused) {
  const auto response = node_->explain("robot/gost", "robot/a");
  EXPECT_FALSE(response.success);
  EXPECT_FALSE(response.reported);
  EXPECT_EQ(response.code.name, "UNKNOWN_ID");
  EXPECT_TRUE(says(response.code.text, "there is no body 'robot/gost'; similar names are 'robot/ghost'"));
  EXPECT_TRUE(std::isnan(response.gap));
  EXPECT_GT(response.world.sequence, 0u);
}

TEST(ExplainPairLimits, APairThatTruncationRemovedIsNotReportedAndTheAnswerSaysWhy) {
  NodeSetup setup;
  setup.params = dict({{"world_frame", "base"}, {"limits/max_pairs", 1}, {"obstacles", list({ball("post", 0, 0, -5, 0.1)})}});
  setup.params["obstacles"][1] = ball("quay", 0, 0, -5, 0.1);
  setup.beside["robot_description"] = balls({});
  NodeUnderTest node(setup);
  node.waitForPairs("both obstacles", [](const msg::Pairs& pairs) { return pairs.total == 2; });
  EXPECT_TRUE(node.explain("obstacle/post", "robot/base").reported);
  const auto cut = node.explain("obstacle/quay", "robot/base");
  EXPECT_FALSE(cut.reported);
  EXPECT_TRUE(says(cut.explanation, "there are more pairs than ~limits/max_pairs allows"));
}

TEST(ExplainPairLimits, TimesBeyondTheHistoryAreRefused) {
  NodeSetup setup;
  setup.beside["robot_description"] = balls({});
  NodeUnderTest node(setup);
  node.waitForComplete();
  EXPECT_TRUE(node.explain("robot/base", "robot/base").success);
  const auto past = node.explain("robot/base", "robot/base", 0, ros::Time(1.0));
  EXPECT_FALSE(past.success);
  EXPECT_EQ(past.code.name, "EXTRAPOLATION");
}

}  // namespace
}  // namespace test
}  // namespace hgrid
