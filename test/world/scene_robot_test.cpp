// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#include <gtest/gtest.h>

#include "test/support/models.h"
#include "test/support/scenes.h"

namespace hgrid {
namespace {

using test::bodiesOf;
using test::Random;

TEST(SceneRobot, EqualRobotsShareTheirMatrixAndFindThePairsOfTheOracle) {
  std::size_t within = 0, between = 0;
  for (unsigned seed = 1; seed <= 60; ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    Random random(seed);
    const RobotModel model = test::randomModel(random, 15);
    LinkRules rules;
    for (int i = 0; i < 5; ++i) {
      rules.disabled.push_back(
          {"link" + std::to_string(random.below(15)), "link" + std::to_string(random.below(15)), ""});
      rules.enabled.push_back(
          {"link" + std::to_string(random.below(15)), "link" + std::to_string(random.below(15)), ""});
    }
    const auto matrix = std::make_shared<const LinkMatrix>(test::matrixOf(model, rules));
    SceneOptions options;
    options.margin = 0.25;
    options.growth_cap = 0.5;
    Scene scene(options);
    std::vector<BodyId> ids;
    for (const char* robot : {"left", "right"}) {
      for (const Body& body : bodiesOf(model, robot, matrix)) ids.push_back(scene.add(body));
    }
    for (int i = 0; i < 10; ++i) test::putRandom(scene, random, "o" + std::to_string(i), 1.0);
    for (int tick = 1; tick <= 10; ++tick) {
      SCOPED_TRACE("tick " + std::to_string(tick));
      for (const BodyId& id : ids) {
        scene.place(id, test::randomPose(random, 1.0), Time{tick});
        const Freshness state = random.chance(0.3) ? Freshness::stale : Freshness::fresh;
        scene.setState(id, state, state == Freshness::stale ? 0.5 : 0.0, std::uint32_t(random.below(3)));
      }
      const auto snapshot = scene.commit(Time{tick}, {});
      ASSERT_NO_FATAL_FAILURE(test::expectPairsOfTheOracle(*snapshot, options.margin));
      for (const NearPair& pair : snapshot->pairs()) {
        const Body &a = snapshot->structure().bodies[pair.first], &b = snapshot->structure().bodies[pair.second];
        within += !a.robot.empty() && a.robot == b.robot;
        between += !a.robot.empty() && !b.robot.empty() && a.robot != b.robot;
      }
    }
  }
  EXPECT_GT(within, 1000u);
  EXPECT_GT(between, 1000u);
}

TEST(SceneRobot, TheHandsOfAHumanoidAreReportedWhenTheyTouch) {
  const RobotModel model = test::humanoid();
  const auto matrix = std::make_shared<const LinkMatrix>(test::matrixOf(model));
  Scene scene{SceneOptions{}};
  double x = 0.0;
  for (const Body& body : bodiesOf(model, "robot", matrix)) {
    const bool is_hand = body.name.find("hand") != std::string::npos;
    test::put(scene, body, test::at(is_hand ? 50.0 : x += 1.0));
  }
  EXPECT_EQ(test::namedPairs(*scene.commit(Time{1}, {})),
            test::NamePairs({{"robot/left_hand_shape", "robot/right_hand_shape"}}));
}

TEST(SceneRobot, AllowedPatternsAndKindsSwitchPairsOff) {
  const auto pairsWith = [](const SceneOptions& options) {
    Scene scene(options);
    test::put(scene, test::ball("a"), test::at(0));
    test::put(scene, test::ball("b"), test::at(0));
    test::put(scene, test::ball("wall", 0.5, Mobility::fixed), test::at(0));
    test::put(scene, test::ball("floor", 0.5, Mobility::fixed), test::at(0));
    return test::namedPairs(*scene.commit(Time{1}, {}));
  };
  SceneOptions options;
  const std::string a = "obstacle/a", b = "obstacle/b", wall = "obstacle/wall", floor = "obstacle/floor";
  EXPECT_EQ(pairsWith(options), test::NamePairs({{a, b}, {a, wall}, {a, floor}, {b, wall}, {b, floor}}));
  options.allowed_pairs = {{"*/wall", "*/a", "it leans there"}};
  EXPECT_EQ(pairsWith(options), test::NamePairs({{a, b}, {a, floor}, {b, wall}, {b, floor}}));
  options.pair_kinds.moving_obstacle = false;
  EXPECT_TRUE(pairsWith(options).empty());
}

TEST(SceneRobot, SinceOutlivesOtherBodiesComingAndGoing) {
  Scene scene{SceneOptions{}};
  test::put(scene, test::ball("m"), test::at(0));
  const BodyId n = test::put(scene, test::ball("n"), test::at(0.5));
  EXPECT_EQ(scene.commit(Time{10}, {})->pairs().at(0).since, Time{10});
  const BodyId a = test::put(scene, test::ball("a"), test::at(50));  // the name is before m and n
  const auto later = scene.commit(Time{20}, {});
  ASSERT_EQ(later->pairs().size(), 1u);
  EXPECT_EQ(later->pairs()[0].first, 1u);
  EXPECT_EQ(later->pairs()[0].since, Time{10});
  scene.remove(a);
  EXPECT_EQ(scene.commit(Time{30}, {})->pairs().at(0).since, Time{10});
  scene.place(n, test::at(50), Time{40});
  EXPECT_TRUE(scene.commit(Time{40}, {})->pairs().empty());
  scene.place(n, test::at(0.5), Time{50});
  EXPECT_EQ(scene.commit(Time{50}, {})->pairs().at(0).since, Time{50});
  scene.remove(n);
  test::put(scene, test::ball("n"), test::at(0.5));
  EXPECT_EQ(scene.commit(Time{60}, {})->pairs().at(0).since, Time{60})
      << "a new body of the same name must begin a new pair";
}

TEST(SceneRobot, TheGapIsThatOfTheNearestShapes) {
  SceneOptions options;
  options.margin = 10.0;
  Scene scene(options);
  Body fork = test::obstacle("fork");
  for (const double x : {0.0, 3.0, 1.0}) {
    fork.shapes.push_back(test::shapeOf(Shape::box({0.5, 0.5, 0.5})));
    fork.shapes.back().body_from_shape.translation().x() = x;
  }
  test::put(scene, fork, test::at(0));
  test::put(scene, fork.shapes.empty() ? fork : test::ball("pea", 0.25), test::at(5));
  const auto snapshot = scene.commit(Time{1}, {});
  ASSERT_EQ(snapshot->pairs().size(), 1u) << "a pair of bodies must be listed only once";
  EXPECT_NEAR(snapshot->pairs()[0].gap, 1.5, 1e-6);
}

TEST(SceneRobot, ALargerMarginOfOneBodyHoldsForItsPairs) {
  SceneOptions options;
  options.margin = 0.25;
  Scene scene(options);
  Body wary = test::ball("wary"), bold = test::ball("bold");
  wary.margin = 2.0;
  bold.margin = 0.125;  // has no effect because it is less than the global margin
  test::put(scene, wary, test::at(0));
  test::put(scene, bold, test::at(2.5));
  test::put(scene, test::ball("third"), test::at(3.75));
  const auto snapshot = scene.commit(Time{1}, {});
  EXPECT_EQ(test::namedPairs(*snapshot),
            test::NamePairs({{"obstacle/bold", "obstacle/third"}, {"obstacle/bold", "obstacle/wary"}}));
  EXPECT_EQ(snapshot->pairs()[0].margin, 0.25);
  EXPECT_EQ(snapshot->pairs()[1].margin, 2.0) << "the larger margin of the two bodies must apply";
}

}  // namespace
}  // namespace hgrid
