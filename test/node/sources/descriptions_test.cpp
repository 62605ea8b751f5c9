// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#include "test/node/support/descriptions.h"

#include <hgrid_proximity/BodyState.h>
#include <hgrid_proximity/Verdict.h>
#include <ros/param.h>

#include <algorithm>

#include "test/node/sources/post_and_robot.h"
#include "test/node/support/claims.h"
#include "test/node/support/transform_source.h"

namespace hgrid {
namespace test {
namespace {

using diagnostic_msgs::DiagnosticStatus;

TEST(Description, ThatIsAbsentOrEmptyOrNoTextIsWaitedForAndObstaclesServe) {
  const std::vector<std::pair<Value, std::string>> cases = {
      {Value(), "NOT_READY robot 'robot': parameter 'robot_description' is not set; it must hold a robot's URDF"},
      {Value(""), "is empty or not a string; it must hold XML"},
      {Value(7), "is empty or not a string; it must hold XML"}};
  for (const auto& one : cases) {
    SCOPED_TRACE(one.second);
    TransformSource transforms;
    NodeSetup setup = besidePost();
    if (one.first.valid()) setup.beside["robot_description"] = one.first;
    NodeUnderTest node(setup);
    const auto status = node.waitForStatus("the missing description is reported", [&](const msg::Status& s) {
      return !s.not_ready.empty() && s.not_ready[0].find(one.second) != std::string::npos;
    });
    EXPECT_EQ(status->not_ready.size(), 1u);
    EXPECT_TRUE(oneSays(status->world.reasons, one.second));
    EXPECT_FALSE(status->world.complete);
    EXPECT_EQ(status->robots, 0u);
    EXPECT_EQ(status->body_count, 1u);
    expectOnlyThePostServes(node);
    waitForDiagnostic(node, "robots", DiagnosticStatus::ERROR, one.second);

    node.setBeside("robot_description", balls({"a", "b"}));
    transforms.stream("base", "a", at(0));
    transforms.stream("base", "b", at(9));
    node.waitForComplete();
    EXPECT_TRUE(node.heard().status.back()->not_ready.empty());
    EXPECT_EQ(node.sphere(0, 0, 0, 0.05).answer.verdict, msg::Verdict::HIT);
    waitForDiagnostic(node, "robots", DiagnosticStatus::OK, "");
    EXPECT_LE(node.lines("NOT_READY robot 'robot'"), 4u) << "logged when it changes, not at every try";
  }
}

TEST(Description, ThatIsNoRobotIsRefusedWithItsPlace) {
  std::string deep = "<robot name=\"r\">";
  for (int i = 0; i < 50000; ++i) deep += "<a>";
  const std::vector<std::pair<std::string, std::string>> cases = {
      {"this is no XML", "PARSE robot 'robot': the URDF is not well-formed XML"},
      {"<robot name=\"r\"><link name=\"a\">", "PARSE robot 'robot': the URDF is not well-formed XML"},
      {deep, "LIMIT robot 'robot': the URDF nests elements 99 levels deep at byte 307; at most 98 are allowed"},
      {"<!DOCTYPE robot [<!ENTITY x \"y\">]><robot/>", "UNSUPPORTED robot 'robot': the URDF has a declaration"},
      {urdf(link("a") + link("b")), "PARSE robot 'robot': "},
      {urdf(link("a") + link("b") + link("c") + joint("b", "c") + joint("c", "b")), "is not reachable from the root"}};
  for (const auto& one : cases) {
    SCOPED_TRACE(one.second);
    NodeSetup setup = besidePost();
    setup.beside["robot_description"] = one.first;
    NodeUnderTest node(setup);
    const auto status = node.waitForStatus("the description is refused", [&](const msg::Status& s) {
      return !s.not_ready.empty() && s.not_ready[0].find(one.second) != std::string::npos;
    });
    EXPECT_FALSE(status->world.complete);
    expectOnlyThePostServes(node);
    EXPECT_TRUE(node.process().alive());
  }
}

TEST(Description, ALinkOnAPlanarOrFloatingJointIsNotPlacedByAStaticTransform) {
  TransformSource transforms;
  transforms.fix({stamped("base", "plate", at(0)), stamped("base", "drone", at(0)), stamped("base", "arm", at(0))});
  NodeSetup setup = besidePost();
  std::string content = link("base");
  for (const auto& [name, type] :
       std::map<std::string, std::string>{{"plate", "planar"}, {"drone", "floating"}, {"arm", "continuous"}}) {
    content += link(name, sphereOf(0.1)) + joint("base", name, type);
  }
  setup.beside["robot_description"] = urdf(content);
  NodeUnderTest node(setup);
  const auto status = node.waitForStatus("the arm is placed, the others are not", [](const msg::Status& s) {
    return stateOf(s, "robot/plate") == msg::BodyState::UNPLACED && s.body_count == 4;
  });
  EXPECT_EQ(stateOf(*status, "robot/drone"), msg::BodyState::UNPLACED);
  EXPECT_EQ(stateOf(*status, "robot/arm"), msg::BodyState::FRESH) << "a joint that is locked";
  EXPECT_TRUE(says(entryOf(*status, "robot/plate")->code.text, "a planar or floating joint moves frame 'plate'"));
  EXPECT_EQ(node.sphere(-9, 0, 0, 0.05).answer.verdict, msg::Verdict::UNKNOWN);
}

TEST(Reload, TakesTheNewModelAndKeepsTheOldOneWhereThatFails) {
  TransformSource transforms;
  transforms.fix({stamped("base", "a", at(0)), stamped("base", "b", at(0.25))});
  NodeSetup setup = besidePost();
  setup.params["watch_descriptions"] = false;
  setup.beside["robot_description"] = balls({"a"});
  NodeUnderTest node(setup);
  node.waitForComplete();
  const auto revision = node.heard().status.back()->world.bodies_revision;

  node.setBeside("robot_description", "<robot>");
  auto answer = node.reload("robot");
  EXPECT_FALSE(answer.success);
  EXPECT_EQ(answer.code.name, "PARSE");
  EXPECT_TRUE(says(answer.code.text, "robot 'robot': the URDF is not well-formed XML"));
  EXPECT_EQ(answer.world.bodies_revision, revision);
  EXPECT_EQ(node.sphere(0, 0, 0, 0.05).answer.verdict, msg::Verdict::HIT) << "the old model is still used";
  const std::string reason =
      "REFUSED 'robot': its newest description could not be used (PARSE robot 'robot': the URDF is not well-formed XML";
  const auto status = node.waitForStatus("the refusal", [](const msg::Status& s) { return !s.world.complete; });
  EXPECT_TRUE(oneSays(status->world.reasons, reason));
  EXPECT_TRUE(oneSays(status->world.reasons, "so its model may be out of date"));
  EXPECT_EQ(status->world.incomplete, std::vector<std::string>({"robot"}));
  const auto source = std::find_if(status->sources.begin(), status->sources.end(),
                                   [](const msg::SourceStatus& one) { return one.name == "robot"; });
  ASSERT_NE(source, status->sources.end());
  EXPECT_FALSE(source->complete);
  EXPECT_TRUE(says(source->reason, reason));
  EXPECT_EQ(node.sphere(9, 0, 0, 0.05).answer.verdict, msg::Verdict::UNKNOWN) << "the new model may be there";
  waitForDiagnostic(node, "robots", DiagnosticStatus::ERROR, "PARSE robot 'robot'");

  node.setBeside("robot_description", balls({"a", "b"}));
  answer = node.reload("");
  EXPECT_TRUE(answer.success);
  EXPECT_EQ(answer.code.name, "OK");
  EXPECT_GT(answer.world.bodies_revision, revision);
  node.waitForBodies("its structure",
                     [&](const msg::Bodies& b) { return b.bodies_revision == answer.world.bodies_revision; });
  const auto pairs = node.waitForPairs("its pairs", [](const msg::Pairs& p) { return p.total > 0; });
  EXPECT_EQ(namesOf(*pairs), std::vector<std::string>({"robot/a|robot/b"}));
  waitForDiagnostic(node, "robots", DiagnosticStatus::OK, "all shapes were read");
  node.waitForComplete();
  node.setBeside("robot_description", balls({"a"}));
  node.waitForTicks(100);  // without ~watch_descriptions, only a request reads the description again
  EXPECT_EQ(node.heard().status.back()->body_count, 4u);
}

/// Claim: a changed description is noticed and read, without a request. While it cannot be used, the old model stays,
/// and the robot is not complete. A description that is gone changes nothing.
TEST(Watch, ReadsAChangedDescription) {
  TransformSource transforms;
  transforms.fix({stamped("base", "a", at(0)), stamped("base", "b", at(0.25))});
  NodeSetup setup = besidePost();
  setup.environment["ROSCONSOLE_STDOUT_LINE_BUFFERED"] = "1";
  setup.beside["robot_description"] = balls({"a"});
  NodeUnderTest node(setup);
  node.waitForComplete();
  const auto waitForBodyCount = [&](std::size_t count) {
    node.waitForStatus(std::to_string(count) + " bodies",
                       [&](const msg::Status& s) { return s.body_count == count && s.world.complete; });
  };
  node.setBeside("robot_description", balls({"a", "b"}));
  waitForBodyCount(4);
  EXPECT_EQ(node.lines("description of robot 'robot' has changed"), 1u) << node.output();

  node.setBeside("robot_description", "<robot>");
  node.waitForStatus("the refusal", [](const msg::Status& s) { return !s.world.complete && s.body_count == 4; });
  EXPECT_TRUE(oneSays(node.heard().status.back()->world.reasons, "REFUSED 'robot': its newest description"));
  EXPECT_EQ(node.sphere(0, 0, 0, 0.05).answer.verdict, msg::Verdict::HIT) << "the old model is still used";
  node.setBeside("robot_description", balls({"a"}));
  waitForBodyCount(3);

  ros::param::del(node.space() + "/robot_description");
  node.setBeside("robot_description_semantic",
                 std::string("<robot name=\"r\"><disable_collisions link1=\"b\" link2=\"a\"/></robot>"));
  node.waitForTicks(100);
  EXPECT_TRUE(node.heard().status.back()->world.complete);
  EXPECT_EQ(node.heard().status.back()->body_count, 3u);
  EXPECT_EQ(node.lines("Robot 'robot' is loaded"), 3u) << "without a URDF, nothing is loaded";
  node.setBeside("robot_description", balls({"a", "b"}));
  node.waitForStatus("the SRDF",
                     [](const msg::Status& s) { return !s.self_pairs.empty() && s.self_pairs[0].srdf == 1; });
}

TEST(Reload, OfARobotThatNobodyNamedIsRefused) {
  NodeSetup setup = besidePost();
  setup.beside["robot_description"] = balls({});
  NodeUnderTest node(setup);
  node.waitForComplete();
  const auto answer = node.reload("robbie\n");
  EXPECT_FALSE(answer.success);
  EXPECT_EQ(answer.code.name, "UNKNOWN_ID");
  EXPECT_TRUE(says(answer.code.text, "there is no robot 'robbie\\x0a' in ~robots"));
  EXPECT_EQ(answer.world.bodies_revision, node.heard().status.back()->world.bodies_revision);
}

}  // namespace
}  // namespace test
}  // namespace hgrid
