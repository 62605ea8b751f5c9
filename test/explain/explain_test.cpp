// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#include "hgrid_proximity/explain/explain.h"

#include <gtest/gtest.h>

#include <cmath>

#include "test/support/maps.h"
#include "test/support/refusals.h"
#include "test/support/rules.h"
#include "test/support/scenes.h"

namespace hgrid {
namespace {

using test::allow;
using test::enable;
using test::refusalOf;
using test::says;

constexpr double kMargin = 0.125;  // [m]

/// A world with an arm and with spheres of radius 0.5 m. The links of the arm are spheres of radius 0.1 m at one place.
/// The box of obstacle/box is 1/16 m away from the box of obstacle/near, and 3 m away from the box of obstacle/far.
class Explain : public ::testing::Test {
 protected:
  static SceneOptions options() {
    SceneOptions options;
    options.margin = kMargin;
    options.growth_cap = 0.5;
    return options;
  }
  Explain() : scene_(options()) {
    LinkRules srdf;
    srdf.disabled = {{"elbow", "base", "Never"}};
    srdf.enabled = {{"hand", "elbow", ""}};
    srdf.disabled_default = {"hand"};
    for (const Body& body : test::armBodies("arm", srdf)) test::put(scene_, body, test::at(20));
    test::put(scene_, test::ball("box"), test::at(0));
    near_ = test::put(scene_, slow("near"), test::at(1.0625));
    test::put(scene_, test::ball("far"), test::at(-4));
    for (const char* name : {"wall", "floor"})
      test::put(scene_, test::ball(name, 0.5, Mobility::fixed), test::at(0, 9));
  }
  static Body slow(const std::string& name) {
    Body body = test::ball(name);
    body.max_speed = 0.25;
    return body;
  }
  /// Explains a pair. Checks that the explanation is the same if the two bodies are exchanged.
  Explanation ask(const std::string& first, const std::string& second, const PairDistance* exact = nullptr) {
    const auto snapshot = scene_.commit(Time{++tick_}, {});
    const Explanation there = explain(*snapshot, first, second, exact), back = explain(*snapshot, second, first, exact);
    EXPECT_EQ(there.reported, back.reported);
    EXPECT_EQ(there.reported, test::namedPairs(*snapshot).count(std::minmax(first, second)) == 1);
    EXPECT_EQ(there.rule.origin, back.rule.origin);
    EXPECT_TRUE(there.gap == back.gap || (std::isnan(there.gap) && std::isnan(back.gap)));
    EXPECT_EQ(there.margin, back.margin);
    EXPECT_EQ(there.margin_first, back.margin_second);
    EXPECT_EQ(there.state_first, back.state_second);
    EXPECT_EQ(there.since, back.since);
    return there;
  }

  Scene scene_;
  BodyId near_;
  int tick_ = 0;
};

TEST_F(Explain, WhatIsReportedIsExplainedByGapAndMargin) {
  const Explanation what = ask("obstacle/box", "obstacle/near");
  EXPECT_TRUE(what.reported);
  EXPECT_TRUE(says(what.text,
                   "obstacle/box and obstacle/near are reported: their boxes are 0.0625 m apart, within the "
                   "margin of 0.125 m"));
  EXPECT_NEAR(what.gap, 0.0625, 1e-6);
  EXPECT_EQ(what.margin, kMargin);
  EXPECT_EQ(what.rule.origin, Origin::none);
  EXPECT_EQ(what.since, Time{1});
  EXPECT_EQ(what.state_first, Freshness::fresh);
  EXPECT_EQ(what.age_first, 0.0);
  EXPECT_EQ(what.measured, Measure::not_measured);
  EXPECT_TRUE(std::isnan(what.distance));
  EXPECT_EQ(ask("obstacle/box", "obstacle/near").since, Time{1}) << "the pair must keep the time when it began";
}

TEST_F(Explain, WhatIsTooFarSaysHowFar) {
  const Explanation what = ask("obstacle/box", "obstacle/far");
  EXPECT_FALSE(what.reported);
  EXPECT_EQ(what.rule.origin, Origin::none);
  EXPECT_NEAR(what.gap, 3.0, 1e-6);
  EXPECT_TRUE(says(what.text, "are not reported: their boxes are 3 m apart, more than the margin of 0.125 m."));
  EXPECT_EQ(what.since, Time{0});
}

TEST_F(Explain, EveryOriginIsToldWithItsReason) {
  PairRule configured = allow("obstacle/box", "obstacle/n*", "it stands on it");
  configured.origin = Origin::parameter;
  scene_.setRules({configured, allow("arm/*", "arm/elbow", "while it is serviced"), allow("arm/hand", "arm/hand", "")});
  struct Row {
    const char *first, *second;
    Origin origin;
    const char* words;
  };
  const Row rows[] = {
      {"arm/hand", "arm/hand", Origin::self, "they are the same body"},
      {"obstacle/wall", "obstacle/floor", Origin::kind, "both are fixed in the world"},
      {"arm/base", "arm/shoulder", Origin::rigid, "both links are of one rigid group"},
      {"arm/hand", "arm/base", Origin::srdf, "the SRDF disables the pair (disable_default_collisions)"},
      {"arm/base", "arm/elbow", Origin::service,
       "rule 'arm/*', 'arm/elbow' of Scene::setRules() allows them to touch (while it is serviced)"},
      {"obstacle/box", "obstacle/near", Origin::parameter,
       "rule 'obstacle/box', 'obstacle/n*' of SceneOptions::allowed_pairs allows them to touch (it stands on it)"},
  };
  for (const Row& row : rows) {
    const Explanation what = ask(row.first, row.second);
    EXPECT_FALSE(what.reported);
    EXPECT_EQ(what.rule.origin, row.origin) << row.first;
    EXPECT_TRUE(what.rule.allowed);
    EXPECT_TRUE(says(what.text, std::string(row.first) + " and " + row.second + " are not reported: " + row.words));
  }
  scene_.setRules({});
  const Explanation srdf = ask("arm/base", "arm/elbow"), adjacent = ask("arm/shoulder", "arm/elbow");
  EXPECT_EQ(srdf.rule.origin, Origin::srdf);
  EXPECT_TRUE(says(srdf.text, "the SRDF disables the pair (Never)"));
  EXPECT_EQ(srdf.rule.reason, "Never");
  EXPECT_EQ(srdf.rule.first, "arm/base");
  EXPECT_EQ(adjacent.rule.origin, Origin::adjacent);
  EXPECT_TRUE(says(adjacent.text, "the links are adjacent: joint 'elbow_joint' connects them."));
}

TEST(ExplainAdjacent, AChainOfJointsIsNamedJointByJoint) {
  const RobotModel model = test::humanoid();
  const auto matrix = std::make_shared<const LinkMatrix>(test::matrixOf(model));
  Scene scene{SceneOptions{}};
  for (const Body& body : test::bodiesOf(model, "robot", matrix)) test::put(scene, body, test::at(0));
  const auto snapshot = scene.commit(Time{1}, {});
  const Explanation what = explain(*snapshot, "robot/torso_shape", "robot/left_upper_arm_shape", nullptr);
  EXPECT_EQ(what.rule.origin, Origin::adjacent);
  EXPECT_TRUE(says(what.text,
                   "the links are adjacent: the 3 joints 'left_shoulder_swing_joint', 'left_shoulder_lift_joint', "
                   "'left_upper_arm_joint' connect them in one place, without geometry between them."));
}

TEST_F(Explain, WhatIsSwitchedOffSaysWhetherItWouldBeReported) {
  scene_.setRules({allow("obstacle/*", "obstacle/*")});
  EXPECT_TRUE(says(ask("obstacle/box", "obstacle/near").text,
                   "allows them to touch. Otherwise they would be reported: their boxes are 0.0625 m apart, within"));
  EXPECT_TRUE(says(ask("obstacle/box", "obstacle/far").text,
                   "allows them to touch. Also, their boxes are 3 m apart, more than"));
}

TEST_F(Explain, WhatIsSwitchedOnAgainstTheModelSaysSo) {
  const Explanation srdf = ask("arm/elbow", "arm/hand");
  EXPECT_TRUE(srdf.reported);
  EXPECT_EQ(srdf.rule.origin, Origin::srdf);
  EXPECT_FALSE(srdf.rule.allowed);
  EXPECT_TRUE(says(srdf.text, "The SRDF's enable_collisions does not allow them to touch."));
  scene_.setRules({enable("arm/base", "arm/shoulder", "they came loose")});
  const Explanation rule = ask("arm/base", "arm/shoulder");
  EXPECT_TRUE(rule.reported);
  EXPECT_EQ(rule.rule.origin, Origin::service);
  EXPECT_TRUE(says(rule.text, "their boxes touch or overlap"));
  EXPECT_TRUE(says(rule.text,
                   "Rule 'arm/base', 'arm/shoulder' of Scene::setRules() does not allow them to touch (they came "
                   "loose)."));
}

TEST_F(Explain, ARuleThatEndsSaysWhen) {
  scene_.setRules({test::until(allow("*", "*"), PairRule::Clock::now() + std::chrono::milliseconds(3599500))});
  EXPECT_TRUE(says(ask("obstacle/box", "obstacle/near").text, "of Scene::setRules(), which ends in 3599."));
}

TEST_F(Explain, AKindThatIsNotNamedIsNamed) {
  SceneOptions with = options();
  with.pair_kinds = PairKinds{false, false, false, false, false};
  Scene scene(with);
  for (const char* robot : {"arm", "leg"}) {
    for (const Body& body : test::armBodies(robot)) test::put(scene, body, test::at(0));
  }
  test::put(scene, test::ball("box"), test::at(0));
  test::put(scene, test::ball("near"), test::at(0));
  Body map = test::ball("x");
  map.name = "map/room";
  map.kind = BodyKind::map;
  test::put(scene, map, test::at(0));
  const auto snapshot = scene.commit(Time{1}, {});
  struct Row {
    const char *first, *second, *kind;
  };
  const Row rows[] = {{"arm/base", "arm/hand", "self"},
                      {"arm/base", "leg/hand", "robot_robot"},
                      {"arm/base", "obstacle/box", "robot_obstacle"},
                      {"arm/base", "map/room", "robot_map"},
                      {"obstacle/box", "obstacle/near", "moving_obstacle"}};
  for (const Row& row : rows) {
    const Explanation what = explain(*snapshot, row.first, row.second, nullptr);
    EXPECT_EQ(what.rule.origin, Origin::kind);
    EXPECT_TRUE(says(what.text,
                     std::string("SceneOptions::pair_kinds does not contain their kind of pair, ") + row.kind + ","));
  }
}

TEST_F(Explain, WhatHasNoPoseOrNoShapeSaysSo) {
  Body ghost = test::ball("ghost");
  ghost.frame = "tool0";
  scene_.add(ghost);
  const Explanation unplaced = ask("obstacle/ghost", "obstacle/box");
  EXPECT_FALSE(unplaced.reported);
  EXPECT_TRUE(
      says(unplaced.text, "are not reported: obstacle/ghost is UNPLACED: it never had a pose (frame 'tool0')."));
  EXPECT_TRUE(std::isnan(unplaced.gap));
  EXPECT_TRUE(std::isnan(unplaced.age_first));
  EXPECT_EQ(unplaced.age_second, 0.0);
  Body bare = test::obstacle("bare");
  bare.note = "PARSE: broken.stl";
  test::put(scene_, bare, test::at(0));
  const Explanation shapeless = ask("obstacle/box", "obstacle/bare");
  EXPECT_TRUE(says(shapeless.text, "obstacle/bare has no shape that could be read: PARSE: broken.stl."));
  EXPECT_TRUE(std::isnan(shapeless.gap));
}

TEST_F(Explain, OnlyAMapWithoutCellsIsCalledEmpty) {
  for (const char* name : {"hall", "shelf"}) {
    const BodyId map = test::put(scene_, test::mapBody(name, Mobility::moving), test::at(0));
    scene_.setCells(map, test::cellsOf(0.25, {{Voxel::kOriginKey, Voxel::kOriginKey, Voxel::kOriginKey, 0}}));
  }
  test::put(scene_, test::mapBody("empty"), test::at(0));
  Body bare = test::obstacle("bare");
  bare.kind = BodyKind::link;
  test::put(scene_, bare, test::at(0));
  const std::string two_maps = ask("map/hall", "map/shelf").text;
  EXPECT_TRUE(says(two_maps, "a pair needs a link of a robot or an obstacle that moves, and neither body is one."));
  EXPECT_FALSE(says(two_maps, "no occupied cells")) << two_maps;
  EXPECT_TRUE(says(ask("map/empty", "obstacle/near").text, "map/empty has no occupied cells"));
  const std::string shapeless = ask("map/hall", "obstacle/bare").text;
  EXPECT_TRUE(says(shapeless, "obstacle/bare has no shape that could be read")) << shapeless;
}

TEST_F(Explain, APairThatTruncationRemovedIsNotAlsoCalledReported) {
  SceneOptions with = options();
  with.max_pairs = 1;
  Scene scene(with);
  for (const char* name : {"a", "b", "c"}) test::put(scene, test::ball(name), test::at(0));
  scene.setRules({enable("obstacle/*", "obstacle/*", "they came loose")});
  const auto snapshot = scene.commit(Time{1}, {});
  const Explanation what = explain(*snapshot, "obstacle/b", "obstacle/c", nullptr);
  EXPECT_TRUE(what.cut);
  EXPECT_TRUE(says(what.text, "are not reported, although their boxes touch or overlap"));
  EXPECT_TRUE(says(what.text, "'obstacle/*', 'obstacle/*' of Scene::setRules() does not allow them to touch"));
  EXPECT_FALSE(says(what.text, "must be reported")) << what.text;
}

TEST_F(Explain, AnInvalidPoseIsToldWithItsCauses) {
  scene_.setState(near_, Freshness::invalid, 0.5);
  EXPECT_TRUE(says(ask("obstacle/near", "obstacle/box").text,
                   "obstacle/near is INVALID: newer data was refused, or several publishers contradict each other; its "
                   "pose is 0.5 s old."));
  const auto snapshot = scene_.commit(Time{9}, {});
  ASSERT_FALSE(snapshot->reasons().empty());
  EXPECT_TRUE(says(snapshot->reasons().front(),
                   "INVALID obstacle/near: newer data was refused, or several publishers contradict each other; its "
                   "pose is 0.5 s old (frame '"));
}

TEST_F(Explain, OldDataIsToldWithWhatItDoesToTheMargin) {
  scene_.setState(near_, Freshness::late, 0.5);
  EXPECT_TRUE(says(ask("obstacle/near", "obstacle/box").text, "obstacle/near is LATE: its pose is 0.5 s old."));
  scene_.setState(near_, Freshness::stale, 1.0);
  const Explanation what = ask("obstacle/near", "obstacle/box");
  EXPECT_TRUE(
      says(what.text,
           "within the margin of 0.375 m. The margin is 0.25 m larger than usual because data is old or comes rarely. "
           "obstacle/near is STALE: its pose is 1 s old."));
  EXPECT_EQ(what.growth, 0.25);
  EXPECT_EQ(what.margin, 0.375);
  EXPECT_EQ(what.margin_first, kMargin);
  EXPECT_EQ(what.state_first, Freshness::stale);
  EXPECT_EQ(what.age_first, 1.0);
  const Explanation far = ask("obstacle/near", "obstacle/far");
  EXPECT_EQ(far.margin, 0.375) << "the margin must include the growth even if the pair is not reported";
}

TEST_F(Explain, TheLargerMarginOfTheTwoApplies) {
  Body wary = test::ball("wary");
  wary.margin = 2.0;
  test::put(scene_, wary, test::at(-2.5));
  const Explanation what = ask("obstacle/wary", "obstacle/box");
  EXPECT_TRUE(what.reported);
  EXPECT_EQ(what.margin, 2.0);
  EXPECT_EQ(what.margin_first, 2.0);
  EXPECT_EQ(what.margin_second, kMargin);
}

TEST_F(Explain, WhatWasMeasuredIsTold) {
  PairDistance exact;
  const auto wordsOf = [&](Measure status, double distance) {
    exact.proximity.status = status;
    exact.proximity.distance = distance;
    const Explanation what = ask("obstacle/box", "obstacle/near", &exact);
    EXPECT_EQ(what.measured, status);
    return what.text;
  };
  EXPECT_TRUE(says(wordsOf(Measure::apart, 0.07), "Their shapes are 0.07 m apart."));
  EXPECT_TRUE(says(wordsOf(Measure::contact, 0.0), "Their shapes are in contact."));
  EXPECT_TRUE(says(wordsOf(Measure::contained, 0.0), "One shape lies inside the other, which counts as contact."));
  EXPECT_TRUE(
      says(wordsOf(Measure::containment_unknown, 0.0), "a mesh that is open or unclear; this counts as contact."));
  EXPECT_TRUE(says(wordsOf(Measure::failed, 0.0), "could not be computed; this counts as contact."));
}

TEST_F(Explain, WhatWasNotReadIsSaidOfAPairThatIsMeasured) {
  Body half = test::ball("half");
  half.covered = false;
  half.note = "its grip could not be read";
  test::put(scene_, half, test::at(0, 3));
  EXPECT_TRUE(says(ask("obstacle/half", "obstacle/box").text,
                   "Not all shapes of obstacle/half could be read, so it may be nearer: its grip could not be read."));
}

TEST(ExplainHorizon, APairThatIsReportedForItSaysSo) {
  SceneOptions options;
  options.margin = kMargin;
  options.horizon = 1.0;
  Scene scene(options);
  Body ball = test::ball("runner");
  ball.max_speed = 1.0;
  test::put(scene, ball, test::at(0));
  test::put(scene, test::ball("wall", 0.5, Mobility::fixed), test::at(1.5));
  const auto snapshot = scene.commit(Time{1}, {});
  const Explanation what = explain(*snapshot, "obstacle/runner", "obstacle/wall", nullptr);
  EXPECT_TRUE(what.reported);
  EXPECT_TRUE(says(what.text,
                   "are reported: their boxes are 0.5 m apart, more than the margin of 0.125 m, but given their "
                   "maximum speeds they can meet within SceneOptions::horizon"));
}

TEST_F(Explain, NamesThatNobodyHasAreRefusedWithWhatIsCalledNearlySo) {
  std::string sentence;
  EXPECT_EQ(refusalOf([&] { ask("obstacle/boks", "obstacle/near"); }, &sentence), Code::unknown_id);
  EXPECT_TRUE(says(sentence, "there is no body 'obstacle/boks'; similar names are 'obstacle/box'"));
  EXPECT_EQ(refusalOf([&] { ask("obstacle/box", "\n"); }, &sentence), Code::unknown_id);
  EXPECT_EQ(sentence, "there is no body '\\x0a'");
}

}  // namespace
}  // namespace hgrid
