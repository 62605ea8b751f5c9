// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
//
// Invalid states and batches. See turning_arm.h for the robot.
#include <gtest/gtest.h>

#include <cmath>

#include "test/queries/states/turning_arm.h"

namespace hgrid {
namespace {

using namespace test;

TEST(StateRefusals, AnInvalidStateIsRefusedByNameAndTheOthersAreAnswered) {
  ArmWorld world;
  put(world.scene, ArmWorld::ballBody("ball"), at(0, 0.5));
  const StateAnswers& answers = world.check({0, std::nan(""), kQuarter, 2e8, -INFINITY, 0});
  const std::vector<Verdict> verdicts{Verdict::clear,   Verdict::unknown, Verdict::hit,
                                      Verdict::unknown, Verdict::unknown, Verdict::clear};
  const std::vector<Code> codes{Code::ok, Code::nonfinite, Code::ok, Code::out_of_range, Code::nonfinite, Code::ok};
  for (std::size_t i = 0; i < verdicts.size(); ++i) {
    SCOPED_TRACE(i);
    EXPECT_EQ(answers.states[i].verdict, verdicts[i]);
    EXPECT_EQ(answers.states[i].refused, codes[i]);
    EXPECT_EQ(answers.states[i].because == Unknown::refused, codes[i] != Code::ok);
    EXPECT_EQ(world.sentences[i].empty(), codes[i] == Code::ok);
  }
  EXPECT_TRUE(says(world.sentences[1], "state 1") && says(world.sentences[1], "arm_joint"));
  EXPECT_TRUE(says(world.sentences[3], text(2e8)) && says(world.sentences[3], text(1e8)));
}

TEST(StateRefusals, AnIncompleteLastStateIsRefusedAndTheOthersAreAnswered) {
  RobotModel model = turningArm();
  addLink(model, "finger", 1, JointKind::prismatic);
  model.links.back().shapes = {solidShape(Shape::sphere(0.01), at(0.7))};
  findRigidGroups(model);
  ArmWorld world({}, model);
  const StateAnswers& answers = world.check({0, 0, 0.5, 0, 1});
  ASSERT_EQ(answers.states.size(), 3u);
  EXPECT_EQ(answers.states[1].verdict, Verdict::clear);
  EXPECT_EQ(answers.states[2].refused, Code::bad_geometry);
  EXPECT_TRUE(says(world.sentences[2], "has 1 values; it must have 2"));
}

TEST(StateRefusals, PositionsBeyondLimitsAreFlaggedAndAnswered) {
  ArmWorld world;
  put(world.scene, ArmWorld::ballBody("ball"), at(-0.5));
  const StateAnswers& answers = world.check({2.0, 2.0001, -1.0, -1.0001, 3.1415926});
  const std::vector<bool> beyond{false, true, false, true, true};
  for (std::size_t i = 0; i < beyond.size(); ++i) EXPECT_EQ(answers.states[i].beyond_limits, beyond[i]) << i;
  EXPECT_EQ(answers.states[3].verdict, Verdict::clear);
  EXPECT_EQ(answers.states[4].verdict, Verdict::hit);
}

TEST(StateRefusals, AQuaternionMustBeNearlyOfLengthOne) {
  RobotModel model = turningArm();
  addLink(model, "drone", 0, JointKind::floating);
  model.links.back().shapes = {solidShape(Shape::sphere(0.01))};
  findRigidGroups(model);
  ArmWorld world({}, model);
  const StateAnswers& answers = world.check({0,     3, 0, 0, 0, 0, 0,
                                             1.001,  //
                                             0,     3, 0, 0, 0, 0, 0,
                                             1.1,  //
                                             0,     3, 0, 0, 0, 0, std::nan(""),
                                             1});
  EXPECT_EQ(answers.states[0].verdict, Verdict::clear);
  EXPECT_EQ(answers.states[1].refused, Code::bad_rotation);
  EXPECT_TRUE(says(world.sentences[1], "drone_joint") && says(world.sentences[1], "unit quaternion"));
  EXPECT_NE(answers.states[2].refused, Code::ok);
  world.batch.joints = {"arm_joint"};
  world.batch.others = {0, 3, 0, 0, 0, 0, 0, 0};
  EXPECT_EQ(refusalOf([&] { world.check({0}); }), Code::bad_rotation);
  world.batch.others.back() = 1.0;
  EXPECT_EQ(world.verdictAt(0), Verdict::clear);
}

TEST(StateRefusals, AMimicJointThatGoesTooFarIsRefusedThroughItsMaster) {
  RobotModel model = turningArm();
  addLink(model, "follower", 0, JointKind::revolute);
  model.links.back().shapes = {solidShape(Shape::sphere(0.01), at(3))};
  model.links.back().mimic = "arm_joint";
  model.links.back().mimic_multiplier = 1e9;
  findRigidGroups(model);
  ArmWorld world({}, model);
  const StateAnswers& answers = world.check({0.05, 0.5});
  EXPECT_EQ(answers.states[0].refused, Code::ok);
  EXPECT_EQ(answers.states[1].refused, Code::out_of_range);
}

TEST(StateRefusals, AMimicJointIsCheckedAlsoIfItsMasterIsTheSameInAllStates) {
  RobotModel model = turningArm();
  addLink(model, "follower", 0, JointKind::revolute);
  model.links.back().shapes = {solidShape(Shape::sphere(0.01), at(3))};
  model.links.back().mimic = "arm_joint";
  model.links.back().mimic_multiplier = 1e9;
  model.links.back().lower = -1e7;
  model.links.back().upper = 1e7;
  addLink(model, "other", 0, JointKind::revolute);
  model.links.back().shapes = {solidShape(Shape::sphere(0.01), at(4))};
  findRigidGroups(model);
  ArmWorld world({}, model);
  world.batch.joints = {"other_joint"};
  const auto check = [&](double master) -> const StateAnswers& {
    world.batch.others = {master, 0.0};
    return world.check({0.1, 0.2});
  };
  for (const StateAnswer& answer : check(0.5).states) EXPECT_EQ(answer.refused, Code::out_of_range);
  EXPECT_TRUE(says(world.sentences[1], "state 1: joint 'arm_joint' has the value 0.5"));
  for (const double master : {0.005, 0.05}) {
    for (const StateAnswer& answer : check(master).states) {
      EXPECT_EQ(answer.verdict, Verdict::clear);
      EXPECT_EQ(answer.beyond_limits, master > 0.01);
    }
  }
}

TEST(StateRefusals, NamesOfJointsMustBeKnownUniqueAndComplete) {
  RobotModel model = turningArm();
  addLink(model, "finger", 1, JointKind::prismatic);
  model.links.back().shapes = {solidShape(Shape::sphere(0.01), at(0.7))};
  findRigidGroups(model);
  ArmWorld world({}, model);
  std::string sentence;
  const auto code = [&] { return refusalOf([&] { world.check({0, 0}); }, &sentence); };
  world.batch.joints = {"arm_joint", "elbow"};
  EXPECT_EQ(code(), Code::unknown_id);
  EXPECT_TRUE(says(sentence, "'elbow'") && says(sentence, "robot"));
  world.batch.joints = {"arm_joint", "arm_joint"};
  EXPECT_EQ(code(), Code::dup_id);
  EXPECT_TRUE(says(sentence, "arm_joint"));
  world.batch.joints = {"arm_joint"};
  EXPECT_EQ(code(), Code::not_ready);
  EXPECT_TRUE(says(sentence, "finger_joint"));
  world.batch.others = {0.0};
  EXPECT_EQ(code(), Code::out_of_range);
  world.batch.others = {0.0, std::nan("")};
  EXPECT_EQ(code(), Code::nonfinite);
  EXPECT_TRUE(says(sentence, "finger_joint"));
  world.batch.others = {0.0, 0.01};
  EXPECT_EQ(code(), Code::ok);
  EXPECT_EQ(world.answers.states.size(), 2u);
}

TEST(StateRefusals, TheRobotMustBeInTheSnapshotWithTheSameLinks) {
  ArmWorld world;
  world.check({0});
  std::string sentence;
  const Kinematics kinematics(world.model);
  const auto check = [&](const Kinematics& joints, const std::string& robot) {
    return refusalOf([&] { StateChecker(world.snapshot, joints, robot, narrowPhase()); }, &sentence);
  };
  EXPECT_EQ(check(kinematics, "robot"), Code::ok);
  EXPECT_EQ(check(kinematics, "other"), Code::unknown_id);
  EXPECT_TRUE(says(sentence, "'other'"));
  RobotModel renamed = world.model;
  renamed.links[1].name = "boom";
  EXPECT_EQ(check(Kinematics(renamed), "robot"), Code::conflict);
  RobotModel longer = world.model;
  addLink(longer, "finger", 1);
  findRigidGroups(longer);
  EXPECT_EQ(check(Kinematics(longer), "robot"), Code::conflict);
  EXPECT_TRUE(says(sentence, "robot/"));
}

TEST(StateRefusals, ThePoseOfTheRootAndTheClearanceMustBeValid) {
  ArmWorld world;
  world.batch.world_from_root = at(std::nan(""));
  EXPECT_EQ(refusalOf([&] { world.check({0}); }), Code::nonfinite);
  world.batch.world_from_root.reset();
  StateRequest request;
  request.clearance = -1.0;
  EXPECT_EQ(refusalOf([&] { world.check({0}, request); }), Code::bad_geometry);
  RobotModel bare = turningArm();
  bare.links[0].has_collision = false;
  ArmWorld without_base({}, bare);
  EXPECT_EQ(refusalOf([&] { without_base.check({0}); }), Code::not_ready);
  without_base.batch.world_from_root = Pose::Identity();
  EXPECT_EQ(without_base.verdictAt(0), Verdict::clear);
}

TEST(StateRefusals, AnEmptyBatchHasNoAnswers) {
  ArmWorld world;
  EXPECT_TRUE(world.check({}).states.empty());
}

}  // namespace
}  // namespace hgrid
