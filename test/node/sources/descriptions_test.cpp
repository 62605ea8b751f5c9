// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#include "test/node/support/descriptions.h"

#include <hgrid_proximity/Verdict.h>
#include <ros/param.h>

#include <algorithm>

#include "test/node/support/claims.h"
#include "test/node/support/transform_source.h"

namespace hgrid {
namespace test {
namespace {

using diagnostic_msgs::DiagnosticStatus;

NodeSetup besidePost() {
  NodeSetup setup;
  setup.params = dict({{"world_frame", "base"}, {"obstacles", list({ball("post", 2, 0, 0, 0.1)})}});
  return setup;
}

void waitForDiagnostic(NodeUnderTest& node, const std::string& name, int level, const std::string& words) {
  node.waitUntil(name + " says " + words, [&](const Heard& all) {
    const auto found = all.diagnostics.find(name);
    return found != all.diagnostics.end() && found->second.level == level &&
           found->second.message.find(words) != std::string::npos;
  });
}

void expectOnlyThePostServes(NodeUnderTest& node) {
  EXPECT_EQ(namesOf(node.sphere(2, 0, 0, 0.05).answer), std::vector<std::string>({"obstacle/post"}));
  EXPECT_EQ(node.sphere(0, 0, 0, 0.05).answer.verdict, msg::Verdict::UNKNOWN) << "the robot may be there";
}

/// Waits until the log has exactly one line with this text. The line may come after the first tick with the robot.
void waitForLine(NodeUnderTest& node, const std::string& text) {
  node.waitUntil("the log says " + text, [&](const Heard&) { return node.lines(text) == 1; });
}

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
      {deep, "LIMIT robot 'robot': the URDF nests elements 257 levels deep at byte 781; at most 256 are allowed"},
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
