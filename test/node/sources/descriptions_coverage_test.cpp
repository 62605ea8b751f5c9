// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
//
// Robots some of whose links have no collision geometry, or geometry that cannot be read.
#include <hgrid_proximity/Verdict.h>

#include <algorithm>

#include "test/node/sources/post_and_robot.h"
#include "test/node/support/claims.h"
#include "test/node/support/descriptions.h"

namespace hgrid {
namespace test {
namespace {

using diagnostic_msgs::DiagnosticStatus;

/// A robot with a link that has a readable sphere, a link with one readable and one unreadable sphere, a link whose
/// mesh file is missing, and a link without geometry.
std::string holey() {
  return urdf(link("base", sphereOf(0.1)) + link("torn", sphereOf(0.1) + collision("<sphere radius=\"nan\"/>")) +
              link("meshless", collision("<mesh filename=\"package://hgrid_proximity/no/such.stl\"/>")) + link("bare") +
              joint("base", "torn", "fixed") + joint("base", "meshless", "fixed") + joint("base", "bare", "fixed"));
}

TEST(Uncovered, ALinkWhoseShapeCannotBeReadIsNamedAndNothingIsClear) {
  NodeSetup setup = besidePost();
  setup.beside["robot_description"] = holey();
  NodeUnderTest node(setup);
  const auto status = node.waitForStatus("the robot", [](const msg::Status& s) { return s.robots == 1; });
  EXPECT_FALSE(status->world.complete);
  EXPECT_EQ(status->uncovered.size(), 2u);
  EXPECT_TRUE(oneSays(status->uncovered, "robot/torn: PARSE: <collision> 2 of link 'torn'"));
  EXPECT_TRUE(oneSays(status->uncovered, "robot/meshless: RESOURCE_MISSING: "));
  EXPECT_TRUE(oneSays(status->uncovered, "no/such.stl"));
  EXPECT_TRUE(oneSays(status->world.reasons, "UNCOVERED robot/torn"));
  EXPECT_EQ(status->without_collision, std::vector<std::string>({"robot/bare"}))
      << "such a link does not make the world incomplete";
  EXPECT_EQ(namesOf(node.sphere(0, 0, 0, 0.05).answer), std::vector<std::string>({"robot/base", "robot/torn"}))
      << "all shapes that could be read are used";
  EXPECT_EQ(node.sphere(9, 0, 0, 0.05).answer.verdict, msg::Verdict::UNKNOWN);
  waitForDiagnostic(node, "robots", DiagnosticStatus::ERROR, "UNCOVERED robot/meshless");
  const auto bodies = node.waitForBodies("structure", [](const msg::Bodies& b) { return b.bodies.size() == 4; });
  EXPECT_EQ(bodies->without_collision, std::vector<std::string>({"robot/bare"}));
  for (const msg::Body& body : bodies->bodies) {
    EXPECT_EQ(body.covered, body.name == "robot/base" || body.name == "obstacle/post") << body.name;
  }
}

TEST(Uncovered, AWaiverMakesTheWorldCompleteAndIsListed) {
  NodeSetup setup = besidePost();
  setup.params["accept_uncovered"] = list({waiver("robot/*", "far from everything")});
  setup.beside["robot_description"] = holey();
  NodeUnderTest node(setup);
  node.waitForComplete();
  const auto status = node.heard().status.back();
  EXPECT_TRUE(status->uncovered.empty());
  EXPECT_EQ(status->waived.size(), 2u);
  EXPECT_TRUE(oneSays(status->waived, "robot/torn: far from everything (PARSE: <collision> 2 of link 'torn'"));
  EXPECT_EQ(node.sphere(9, 0, 0, 0.05).answer.verdict, msg::Verdict::CLEAR);
  const auto bodies = node.waitForBodies("structure", [](const msg::Bodies& b) { return b.bodies.size() == 4; });
  for (const msg::Body& body : bodies->bodies) {
    EXPECT_EQ(body.waived, body.name == "robot/torn" || body.name == "robot/meshless") << body.name;
  }
}

/// A robot without collision geometry. Its second link has visual geometry.
std::string visualOnly() {
  return urdf(link("base") + link("shell", visual("<sphere radius=\"0.1\"/>")) + joint("base", "shell", "fixed"));
}

const std::string kNoGeometry = "robot 'robot' has no collision geometry on any of its 2 links";

NodeSetup withVisualOnly() {
  NodeSetup setup = besidePost();
  setup.beside["robot_description"] = visualOnly();
  return setup;
}

TEST(NoGeometry, ARobotWithoutCollisionGeometryMakesTheWorldIncomplete) {
  NodeUnderTest node(withVisualOnly());
  const auto status = node.waitForStatus("the robot", [](const msg::Status& s) { return s.robots == 1; });
  const std::string sentence = kNoGeometry + "; set ~use_visual or waive all of its links with ~accept_uncovered";
  EXPECT_FALSE(status->world.complete);
  EXPECT_EQ(status->world.reasons, std::vector<std::string>({"UNCOVERED " + sentence}));
  EXPECT_EQ(status->not_ready, std::vector<std::string>({"UNCOVERED " + sentence}));
  EXPECT_EQ(status->uncovered, std::vector<std::string>({sentence}));
  EXPECT_EQ(status->without_collision, std::vector<std::string>({"robot/base", "robot/shell"}));
  expectOnlyThePostServes(node);
  waitForDiagnostic(node, "robots", DiagnosticStatus::ERROR, "UNCOVERED " + sentence);

  node.setBeside("robot_description", balls({}));
  ASSERT_TRUE(node.reload("robot").success);
  node.waitForComplete();
  node.setBeside("robot_description", visualOnly());
  ASSERT_TRUE(node.reload("robot").success);
  expectOnlyThePostServes(node);
}

TEST(NoGeometry, AWaiverForEveryLinkMakesTheWorldCompleteAndIsListed) {
  NodeSetup setup = withVisualOnly();
  setup.params["accept_uncovered"] = list({waiver("robot/base", "in the floor"), waiver("robot/sh*", "only shown")});
  NodeUnderTest node(setup);
  node.waitForComplete();
  const auto status = node.heard().status.back();
  EXPECT_EQ(status->waived, std::vector<std::string>({kNoGeometry + ": in the floor; only shown"}));
  EXPECT_TRUE(status->uncovered.empty());
  EXPECT_TRUE(status->model_warnings.empty()) << status->model_warnings.front();
  waitForDiagnostic(node, "robots", DiagnosticStatus::OK, "all shapes were read, except those that are waived");
  EXPECT_EQ(node.sphere(0, 0, 0, 0.05).answer.verdict, msg::Verdict::CLEAR);
}

TEST(NoGeometry, AWaiverForSomeOfTheLinksIsNotEnough) {
  NodeSetup setup = withVisualOnly();
  setup.params["accept_uncovered"] = list({waiver("robot/shell", "only shown")});
  NodeUnderTest node(setup);
  const auto status = node.waitForStatus("the robot", [](const msg::Status& s) { return s.robots == 1; });
  EXPECT_TRUE(oneSays(status->world.reasons, kNoGeometry));
  EXPECT_TRUE(status->waived.empty());
  EXPECT_EQ(node.sphere(0, 0, 0, 0.05).answer.verdict, msg::Verdict::UNKNOWN);
}

TEST(NoGeometry, AWaiverForALinkWithoutGeometryIsNotIdle) {
  NodeSetup setup = besidePost();
  setup.params["accept_uncovered"] = list({waiver("robot/bare", "a frame"), waiver("robot/bear", "misspelled")});
  setup.beside["robot_description"] = holey();
  NodeUnderTest node(setup);
  const auto status = node.waitForStatus("the robot", [](const msg::Status& s) { return s.robots == 1; });
  EXPECT_EQ(status->model_warnings, std::vector<std::string>({"~accept_uncovered: 'robot/bear' matches no body"}));
  EXPECT_EQ(status->uncovered.size(), 2u) << "the links with unreadable shapes, not robot/bare";
  EXPECT_TRUE(status->waived.empty());
}

TEST(VisualGeometry, IsUsedWhereAPatternMatchesAndIsListed) {
  NodeSetup setup = withVisualOnly();
  setup.params["use_visual"] = list({"robot/*", "robot/none"});
  NodeUnderTest node(setup);
  node.waitForComplete();
  const auto status = node.heard().status.back();
  EXPECT_EQ(namesOf(node.sphere(0, 0, 0, 0.05).answer), std::vector<std::string>({"robot/shell"}));
  EXPECT_EQ(node.sphere(0, 0, 0, 0.05).answer.verdict, msg::Verdict::HIT);
  EXPECT_EQ(node.sphere(0, 0, 1, 0.05).answer.verdict, msg::Verdict::CLEAR);
  EXPECT_EQ(status->uses_visual, std::vector<std::string>({"robot/shell"}));
  EXPECT_EQ(status->without_collision, std::vector<std::string>({"robot/base"}));
  EXPECT_EQ(status->model_warnings, std::vector<std::string>({"~use_visual: 'robot/none' matches no body"}));
  node.waitUntil("/diagnostics list the link", [](const Heard& all) {
    const auto found = all.diagnostics.find("robots");
    if (found == all.diagnostics.end()) return false;
    return std::any_of(found->second.values.begin(), found->second.values.end(), [](const auto& entry) {
      return entry.key == "uses visual geometry 1" && entry.value == "robot/shell";
    });
  });
  waitForLine(node, "~use_visual: 'robot/none' matches no body");
}

TEST(VisualGeometry, ThatCannotBeReadIsUncovered) {
  NodeSetup setup = besidePost();
  setup.params["use_visual"] = list({"*"});
  setup.beside["robot_description"] = urdf(link("base", visual("<mesh filename=\"package://no_such/a.stl\"/>")));
  NodeUnderTest node(setup);
  const auto status = node.waitForStatus("the robot", [](const msg::Status& s) { return s.robots == 1; });
  EXPECT_TRUE(oneSays(status->uncovered, "robot/base: RESOURCE_MISSING: <visual> 1 of link 'base'"));
  EXPECT_EQ(node.sphere(9, 0, 0, 0.05).answer.verdict, msg::Verdict::UNKNOWN);
}

}  // namespace
}  // namespace test
}  // namespace hgrid
