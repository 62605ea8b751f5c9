// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
//
// Compares the answers for two joined robots with the answers for one robot. For these, the other robot is a part of
// the world, and an oracle has placed its links.
#include "hgrid_proximity/bodies/joined_robots.h"

#include <gtest/gtest.h>

#include "test/queries/states/turning_arm.h"
#include "test/support/refusals.h"

namespace hgrid {
namespace {

using namespace test;

constexpr double kNear = 0.1;  // [m] clearance that is asked for

/// Two robots among obstacles. The right one holds an obstacle.
class TwoRobots {
 public:
  explicit TwoRobots(Random& random) {
    for (Robot& robot : robots) {
      robot.model = randomMechanism(random, 5, 0.25);
      addShapes(robot.model, random);
      robot.world_from_root = randomPose(random, 0.4);
      matrices_.push_back(std::make_shared<const LinkMatrix>(matrixOf(robot.model)));
      for (Body& body : bodiesOf(robot.model, robot.name, matrices_.back())) {
        body.frame = robot.name + "." + robot.model.links[body.link].name;
        robot.bodies.emplace_back(static_cast<int>(body.link), put(scene, body, randomPose(random, 1.0)));
      }
    }
    for (int i = 0; i < 4; ++i) {
      Body body = obstacle(std::to_string(i));
      body.shapes.push_back(solidShape(randomShape(random, 0.2)));
      put(scene, body, randomPose(random, 1.0));
    }
    Body body = obstacle("held");
    body.frame = "right.link4";
    body.frame_from_body = hand_from_held;
    body.shapes.push_back(solidShape(Shape::box({0.05, 0.1, 0.15})));
    held = put(scene, body, randomPose(random, 1.0));
  }

  /// Places the links of a robot, and what it holds, where a state puts them.
  void place(std::size_t number, const std::vector<double>& state) {
    const Robot& robot = robots[number];
    const JointOracle oracle(robot.model, Kinematics(robot.model), state);
    for (const auto& [link, body] : robot.bodies) {
      scene.place(body, robot.world_from_root * oracle.rootFromLink(link), Time{1});
    }
    if (number == 1) scene.place(held, robot.world_from_root * oracle.rootFromLink(4) * hand_from_held, Time{1});
  }
  /// Checks a state of one robot. The other one stands where place() has put it.
  StateAnswer check(std::size_t number, const std::vector<double>& state, const StateRequest& request) {
    const Robot& robot = robots[number];
    const StateChecker checker(scene.commit(Time{2}, {}), Kinematics(robot.model), robot.name, narrowPhase());
    StateBatch batch;
    append(batch, state);
    batch.world_from_root = robot.world_from_root;
    StateScratch scratch;
    StateAnswers answers;
    checker.checkStates(batch, request, scratch, answers);
    return answers.states.at(0);
  }
  Kinematics joined() const {
    return Kinematics(joinRobots({{"left", &robots[0].model, robots[0].world_from_root},
                                  {"right", &robots[1].model, robots[1].world_from_root}}));
  }

  struct Robot {
    std::string name;
    RobotModel model{};
    Pose world_from_root{};
    std::vector<std::pair<int, BodyId>> bodies{};  // with the index of the link
  };
  std::vector<Robot> robots{{"left"}, {"right"}};
  const Pose hand_from_held = at(0.1, 0.02, -0.03);
  BodyId held{};
  Scene scene{SceneOptions{}};

 private:
  std::vector<std::shared_ptr<const LinkMatrix>> matrices_;
};

TEST(JoinedRobots, AreCheckedLikeOneRobotInAWorldWithTheOther) {
  Random random(11);
  StateRequest near;
  near.clearance = kNear;
  int hits = 0, close = 0, far = 0, only_right_hits = 0;
  const int worlds = std::max(5, countFromEnvironment("HGRID_TEST_CHECKED_STATES", 10000) / 500);
  for (int world = 0; world < worlds; ++world) {
    TwoRobots two(random);
    const Kinematics joined = two.joined(), of_left(two.robots[0].model), of_right(two.robots[1].model);
    StateCheckerOptions left_counts;
    left_counts.robots = {"left"};
    const auto snapshot = two.scene.commit(Time{2}, {});
    const StateChecker left(snapshot, joined, "", narrowPhase(), left_counts), all(snapshot, joined, "", narrowPhase());
    StateScratch scratch;
    for (int i = 0; i < 40; ++i) {
      const std::vector<double> at_left = randomState(random, of_left), at_right = randomState(random, of_right);
      StateBatch batch;
      append(batch, at_left);
      append(batch, at_right);
      StateAnswers of_one, of_all;
      left.checkStates(batch, near, scratch, of_one);
      all.checkStates(batch, near, scratch, of_all);
      two.place(1, at_right);
      const StateAnswer expected = two.check(0, at_left, near);
      ASSERT_EQ(of_one.states[0].verdict, expected.verdict) << of_one.states[0].clearance << " " << expected.clearance;
      if (std::isfinite(expected.clearance)) {
        ASSERT_NEAR(of_one.states[0].clearance, expected.clearance, 1e-9);
      } else {
        ASSERT_EQ(of_one.states[0].clearance, expected.clearance);
      }
      two.place(0, at_left);
      const StateAnswer other = two.check(1, at_right, near);
      const bool any = expected.verdict == Verdict::hit || other.verdict == Verdict::hit;
      ASSERT_EQ(of_all.states[0].verdict, any ? Verdict::hit : Verdict::clear);
      only_right_hits += any && expected.verdict != Verdict::hit ? 1 : 0;
      hits += expected.verdict == Verdict::hit ? 1 : 0;
      (std::isinf(expected.clearance) ? far : close) += expected.verdict == Verdict::clear ? 1 : 0;
    }
  }
  EXPECT_GT(hits, 20);
  EXPECT_GT(close, 20);
  EXPECT_GT(far, 5);
  EXPECT_GT(only_right_hits, 5);
}

TEST(JoinedRobots, HaveTheVariablesOfAllRobotsInTheirOrder) {
  Random random(12);
  const TwoRobots two(random);
  const Kinematics joined = two.joined();
  std::vector<std::string> names, expected;
  for (const JointVariable& variable : joined.variables()) names.push_back(variable.name);
  for (const TwoRobots::Robot& robot : two.robots) {
    const Kinematics own(robot.model);
    for (const JointVariable& variable : own.variables()) expected.push_back(robot.name + "/" + variable.name);
  }
  EXPECT_EQ(names, expected);
  EXPECT_EQ(joined.name(), "left and right");
}

TEST(JoinedRobots, OfAnotherModelThanTheSnapshotHasAreRefused) {
  Random random(13);
  TwoRobots two(random);
  const auto snapshot = two.scene.commit(Time{2}, {});
  two.robots[1].model.links[0].name = "renamed";
  std::string sentence;
  EXPECT_EQ(refusalOf([&] { StateChecker(snapshot, two.joined(), "", narrowPhase()); }, &sentence), Code::conflict);
  EXPECT_TRUE(says(sentence, "'right/link0' is not the same link in the snapshot and in the model of the joints"));
}

TEST(JoinedRobots, ThatAreNotInTheSnapshotAreRefusedByName) {
  Random random(14);
  TwoRobots two(random);
  const auto snapshot = two.scene.commit(Time{2}, {});
  StateCheckerOptions options;
  options.robots = {"middle"};
  std::string sentence;
  EXPECT_EQ(refusalOf([&] { StateChecker(snapshot, two.joined(), "", narrowPhase(), options); }, &sentence),
            Code::unknown_id);
  EXPECT_TRUE(says(sentence, "robot 'middle' is not among the robots that are checked"));
  const RobotModel& model = two.robots[0].model;
  const Kinematics more(joinRobots({{"left", &model, Pose::Identity()}, {"missing", &model, Pose::Identity()}}));
  EXPECT_EQ(refusalOf([&] { StateChecker(snapshot, more, "", narrowPhase()); }, &sentence), Code::unknown_id);
  EXPECT_TRUE(says(sentence, "robot 'missing' has no links in the snapshot"));
}

TEST(JoinedRobots, WhoseRootLinksHaveNoPoseAreRefused) {
  Random random(15);
  TwoRobots two(random);
  const auto snapshot = two.scene.commit(Time{2}, {});
  const auto refused = [&](const Pose& pose) {
    two.robots[1].world_from_root = pose;
    return refusalOf([&] { StateChecker(snapshot, two.joined(), "", narrowPhase()); });
  };
  EXPECT_EQ(refused(at(std::nan(""))), Code::nonfinite);
  EXPECT_EQ(refused(at(1e39)), Code::out_of_range);
  Pose twisted = at(1);
  twisted.linear() *= 2.0;
  EXPECT_EQ(refused(twisted), Code::bad_rotation);
}

/// Returns the verdict for two joined robots with one joint each, whose positions are 0.
Verdict verdictAtZero(Scene& scene, const std::vector<JoinedRobot>& robots, const StateCheckerOptions& options = {}) {
  const StateChecker checker(scene.commit(Time{2}, {}), Kinematics(joinRobots(robots)), "", narrowPhase(), options);
  StateBatch batch;
  append(batch, {0.0, 0.0});
  StateScratch scratch;
  StateAnswers answers;
  checker.checkStates(batch, {}, scratch, answers);
  return answers.states.at(0).verdict;
}

// Claim: an obstacle on the root link of a robot is in doubt if it is LOST, whatever the state of the other robot is.
TEST(JoinedRobots, DoNotHideTheDoubtAboutWhatTheOtherOneHolds) {
  const RobotModel model = turningArm();
  const auto matrix = std::make_shared<const LinkMatrix>(matrixOf(model));
  Scene scene{SceneOptions{}};
  const std::vector<JoinedRobot> robots{{"left", &model, at(0)}, {"right", &model, at(5)}};
  std::vector<BodyId> bases;
  for (const JoinedRobot& robot : robots) {
    for (Body& body : bodiesOf(model, robot.name, matrix)) {
      body.frame = robot.name + "." + model.links[body.link].name;
      const BodyId id = put(scene, body, robot.world_from_root);
      if (body.link == 0) bases.push_back(id);
    }
  }
  Body body = ArmWorld::ballBody("held");
  body.frame = "right.base";
  body.frame_from_body = at(0, -0.5);
  const BodyId held = put(scene, body, at(5, -0.5));
  const auto verdict = [&] { return verdictAtZero(scene, robots); };
  EXPECT_EQ(verdict(), Verdict::clear);
  scene.setState(held, Freshness::lost, 5.0);
  EXPECT_EQ(verdict(), Verdict::unknown);
  scene.setState(bases.at(0), Freshness::lost, 5.0);
  EXPECT_EQ(verdict(), Verdict::unknown);
}

// Claim: what touches the base of a robot that does not count is not reported, although this base is beside one that
// counts. There are so many obstacles that the grid is searched for them.
TEST(JoinedRobots, OfWhichOneDoesNotCountMayTouchObstaclesWithIt) {
  RobotModel model = turningArm();
  model.links[1].has_collision = false;
  model.links[1].shapes.clear();
  const auto matrix = std::make_shared<const LinkMatrix>(matrixOf(model));
  const std::vector<JoinedRobot> robots{{"left", &model, at(0)}, {"right", &model, at(0.25)}};
  Scene scene{SceneOptions{}};
  for (const JoinedRobot& robot : robots) {
    for (const Body& body : bodiesOf(model, robot.name, matrix)) put(scene, body, robot.world_from_root);
  }
  put(scene, ArmWorld::ballBody("touches right"), at(0.42));
  for (int i = 0; i < 40; ++i) put(scene, ArmWorld::ballBody(std::to_string(i)), at(3.0 + i));
  StateCheckerOptions options;
  EXPECT_EQ(verdictAtZero(scene, robots, options), Verdict::hit);
  options.robots = {"right"};
  EXPECT_EQ(verdictAtZero(scene, robots, options), Verdict::hit);
  options.robots = {"left"};
  EXPECT_EQ(verdictAtZero(scene, robots, options), Verdict::clear);
}

}  // namespace
}  // namespace hgrid
