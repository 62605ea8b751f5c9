// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
//
// The bodies and pairs of described robots, beside other robots and obstacles.
#include <hgrid_proximity/Verdict.h>

#include "test/node/sources/post_and_robot.h"
#include "test/node/support/claims.h"
#include "test/node/support/descriptions.h"
#include "test/node/support/transform_source.h"

namespace hgrid {
namespace test {
namespace {

using diagnostic_msgs::DiagnosticStatus;

/// A robot with a base, a torso and two arms. Each arm has two moving joints, 0.3 m apart, and a hand. Each hand wears
/// a link that is called "glove". Fixed joints connect the torso to the base, and each glove to its hand. Only the
/// torso and the gloves have shapes.
std::string twoArms() {
  std::string content = link("base") + link("torso", sphereOf(0.1, "0 0 -5")) + joint("base", "torso", "fixed");
  for (const std::string side : {"left", "right"}) {
    const std::string arm = side + "_arm", hand = side + "_hand", glove = side + "_glove";
    content += link(arm) + link(hand) + link(glove, sphereOf(0.1)) + joint("base", arm, "continuous") +
               joint(arm, hand, "continuous", "<origin xyz=\"0.3 0 0\"/>") + joint(hand, glove, "fixed");
  }
  return urdf(content);
}

TEST(SelfPairs, HandsWhoseArmsHaveNoGeometryAreReportedWhenTheyAreNear) {
  TransformSource transforms;
  transforms.fix({stamped("base", "left_hand", at(0)), stamped("base", "right_hand", at(0.25))});
  NodeSetup setup = besidePost();
  setup.beside["robot_description"] = twoArms();
  NodeUnderTest node(setup);
  node.waitForComplete();
  const auto pairs = node.waitForPairs("the hands", [](const msg::Pairs& p) { return p.world.complete; });
  EXPECT_EQ(namesOf(*pairs), std::vector<std::string>({"robot/left_glove|robot/right_glove"}));
  const auto& counts = node.heard().status.back()->self_pairs;
  ASSERT_EQ(counts.size(), 1u);
  EXPECT_EQ(counts[0].robot, "robot");
  EXPECT_EQ(counts[0].links, 3u);
  EXPECT_EQ(counts[0].pairs, 3u);
  EXPECT_EQ(counts[0].rigid + counts[0].adjacent + counts[0].srdf, 0u);
}

TEST(SelfPairs, ARobotWhosePairsAreAllOffIsAWarning) {
  TransformSource transforms;
  transforms.fix({stamped("base", "a", at(0)), stamped("base", "b", at(9))});
  NodeSetup setup = besidePost();
  setup.environment["ROSCONSOLE_STDOUT_LINE_BUFFERED"] = "1";
  setup.params["watch_descriptions"] = false;
  setup.beside["robot_description"] = balls({"a", "b"});
  setup.beside["robot_description_semantic"] =
      std::string("<robot name=\"r\"><disable_collisions link1=\"a\" link2=\"b\"/></robot>");
  NodeUnderTest node(setup);
  node.waitForComplete();
  const std::string all = "3 of the 3 pairs of its 3 links with geometry are off (0 rigid, 2 adjacent, 1 by SRDF)";
  waitForLine(node, "Robot 'robot' is loaded: " + all);
  const auto& counts = node.heard().status.back()->self_pairs;
  ASSERT_EQ(counts.size(), 1u);
  EXPECT_EQ(counts[0].pairs, 3u);
  EXPECT_EQ(counts[0].adjacent, 2u);
  EXPECT_EQ(counts[0].srdf, 1u);
  waitForDiagnostic(node, "robots", DiagnosticStatus::WARN, "robot: " + all);

  node.setBeside("robot_description_semantic", std::string("<robot name=\"r\"/>"));
  ASSERT_TRUE(node.reload("robot").success);
  waitForDiagnostic(node, "robots", DiagnosticStatus::OK, "all shapes were read");
  waitForLine(node, "2 of the 3 pairs of its 3 links with geometry are off (0 rigid, 2 adjacent, 0 by SRDF)");
}

TEST(TwoRobots, WithTheSameLinkNamesAreKeptApart) {
  TransformSource transforms;
  for (const std::string side : {"left", "right"}) {
    const double y = side == "left" ? 0.0 : 0.25;
    transforms.fix({stamped("world", side + "/base", at(0, y, 0)), stamped(side + "/base", side + "/a", at(0)),
                    stamped(side + "/base", side + "/b", at(9))});
  }
  const auto robot = [](const char* name) {
    return dict({{"name", name}, {"description", "robot_description"}, {"tf_prefix", name}});
  };
  NodeSetup setup;
  setup.params = dict({{"world_frame", "world"}, {"robots", list({robot("right"), robot("left")})}});
  setup.beside["robot_description"] = balls({"a", "b"});
  NodeUnderTest node(setup);
  node.waitForComplete();
  const auto status = node.heard().status.back();
  EXPECT_EQ(status->robots, 2u);
  EXPECT_EQ(status->body_count, 6u);
  const auto pairs = node.heard().pairs.back();
  EXPECT_EQ(namesOf(*pairs), std::vector<std::string>({"left/a|right/a", "left/b|right/b", "left/base|right/base"}));
  for (const double gap : pairs->gap) EXPECT_NEAR(gap, 0.05, 1e-6);
  EXPECT_EQ(namesOf(node.sphere(0, 0, 0, 0.05).answer), std::vector<std::string>({"left/a"}));
}

/// Claim: an obstacle and a link of the same name are two bodies.
TEST(Names, OfAnObstacleAndALinkMayBeEqual) {
  TransformSource transforms;
  transforms.fix({stamped("base", "a", at(0.25))});
  NodeSetup setup;
  setup.params = dict({{"world_frame", "base"}, {"obstacles", list({ball("a", 0, 0, 0, 0.1)})}});
  setup.beside["robot_description"] = balls({"a"});
  NodeUnderTest node(setup);
  node.waitForComplete();
  EXPECT_EQ(node.heard().status.back()->body_count, 3u);
  EXPECT_EQ(namesOf(*node.heard().pairs.back()), std::vector<std::string>({"obstacle/a|robot/a"}));
  EXPECT_EQ(namesOf(node.sphere(0, 0, 0, 0.05).answer), std::vector<std::string>({"obstacle/a"}));
  EXPECT_EQ(namesOf(node.sphere(0.25, 0, 0, 0.05).answer), std::vector<std::string>({"robot/a"}));
}

/// Claim: an obstacle that follows a link stays at its last place when the link disappears, and nothing there is clear.
TEST(Obstacles, WhoseLinkDisappearsStayAtTheirLastPlace) {
  TransformSource transforms;
  transforms.stream("base", "a", at(1));
  NodeSetup setup;
  setup.params = dict({{"world_frame", "base"},
                       {"late_after", 0.1},
                       {"stale_after", 0.2},
                       {"lost_after", 0.5},
                       {"obstacles", list({ball("tool", 0, 0, 1, 0.1, "a")})}});
  setup.beside["robot_description"] = balls({"a"});
  NodeUnderTest node(setup);
  node.waitForComplete();
  transforms.stop("a");
  node.setBeside("robot_description", balls({}));
  node.waitForStatus("the lost obstacle", [](const msg::Status& s) {
    return s.body_count == 2 && s.world.incomplete == std::vector<std::string>({"obstacle"});
  });
  EXPECT_TRUE(oneSays(node.heard().status.back()->world.reasons, "LOST obstacle/tool"));
  EXPECT_EQ(namesOf(node.sphere(1, 0, 1, 0.05).answer), std::vector<std::string>({"obstacle/tool"}));
  EXPECT_EQ(node.sphere(1, 0, 0, 0.05).answer.verdict, msg::Verdict::UNKNOWN) << "the tool may have moved";
}

TEST(Reset, BeginsAnEpochWithTheObstaclesAsConfiguredAndCountersAtZero) {
  TransformSource transforms;
  transforms.fix({stamped("base", "a", at(2.25))});
  NodeSetup setup = besidePost();
  setup.beside["robot_description"] = balls({"a"});
  NodeUnderTest node(setup);
  node.waitForComplete();
  for (int i = 0; i < 5; ++i) node.sphere(0, 0, 0, -1);
  const auto before = node.waitForStatus(
      "counters", [](const msg::Status& s) { return counter(s, "query.refused.BAD_GEOMETRY") == 5; });
  EXPECT_TRUE(node.reset().success);
  const auto after =
      node.waitForStatus("a new epoch", [&](const msg::Status& s) { return s.world.epoch != before->world.epoch; });
  EXPECT_LE(after->world.sequence, 3u);
  EXPECT_EQ(counter(*after, "query.refused.BAD_GEOMETRY"), 0u);
  EXPECT_TRUE(after->world.complete);
  EXPECT_EQ(after->body_count, before->body_count);
  const auto pairs =
      node.waitForPairs("the new epoch", [&](const msg::Pairs& p) { return p.world.epoch == after->world.epoch; });
  EXPECT_EQ(namesOf(*pairs), std::vector<std::string>({"obstacle/post|robot/a"}));
  node.waitForBodies("the new epoch", [&](const msg::Bodies& b) { return b.epoch == after->world.epoch; });
  EXPECT_EQ(namesOf(node.sphere(2, 0, 0, 0.05).answer), std::vector<std::string>({"obstacle/post"}));
}

}  // namespace
}  // namespace test
}  // namespace hgrid
