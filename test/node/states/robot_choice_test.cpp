// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#include "src/node/states/robot_choice.h"

#include <gtest/gtest.h>

#include "hgrid_proximity/adapters/urdf.h"
#include "test/node/support/settings.h"
#include "test/support/refusals.h"

namespace hgrid {
namespace {

using test::refusalOf;
using test::says;

const char* const kUrdf =
    "<robot name='r'><link name='base'/><link name='arm'/><joint name='shoulder' type='continuous'>"
    "<parent link='base'/><child link='arm'/></joint></robot>";

/// Robots that are all loaded from one URDF.
class RobotChoice : public ::testing::Test {
 protected:
  RobotChoice() {
    params_.max_links = 10;
    add("left", "<robot name='r'><group name='arm'><joint name='shoulder'/></group></robot>");
    add("right", "<robot name='r'><virtual_joint name='rail' type='floating' parent_frame='a' child_link='base'/></robot>");
  }
  void add(const std::string& name, const std::string& srdf) {
    const auto read = std::make_shared<ReadDescription>();
    read->model = readUrdf(kUrdf, nullptr);
    read->joints = std::make_shared<const RobotJoints>(read->model, &srdf, DescriptionLimits{});
    const auto robot = std::make_shared<LoadedRobot>();
    robot->name = name;
    robot->bodies.resize(1);
    robot->read = read;
    robots_[name].model = robot;
  }
  /// Returns the name of the chosen robot, or the code with which the request is refused.
  std::string choice(const std::vector<std::string>& joints, const std::string& group = "") {
    Tick tick;
    tick.settings = test::settingsOf(params_);
    tick.robots = std::make_shared<const RobotEntries>(robots_);
    std::string chosen;
    const Code code = refusalOf([&] { chosen = robotWith(joints, group, tick).name; }, &sentence_);
    return code == Code::ok ? chosen : name(code);
  }

  Params params_;
  RobotEntries robots_;
  std::string sentence_;
};

TEST_F(RobotChoice, IsTheOnlyRobotThatHasAllJointsAndTheGroup) {
  EXPECT_EQ(choice({"left/shoulder"}), "left");
  EXPECT_EQ(choice({"right/shoulder"}), "right");
  EXPECT_EQ(choice({"shoulder"}, "arm"), "left");
  EXPECT_EQ(choice({"shoulder", "rail"}), "right");
  EXPECT_EQ(choice({"shoulder"}), "CONFLICT");
  EXPECT_TRUE(says(sentence_, "left, right")) << sentence_;
  EXPECT_EQ(choice({"elbow"}), "UNKNOWN_ID");
  EXPECT_TRUE(says(sentence_, "'elbow'")) << sentence_;
  EXPECT_EQ(choice({"rail"}, "arm"), "UNKNOWN_ID") << "they are those of different robots";
  EXPECT_EQ(choice({}, "leg"), "UNKNOWN_ID");
  EXPECT_TRUE(says(sentence_, "'leg'")) << sentence_;
  EXPECT_EQ(choice(std::vector<std::string>(81, "shoulder")), "LIMIT");
  EXPECT_TRUE(says(sentence_, "at most 80")) << sentence_;
}

TEST_F(RobotChoice, WithoutNamesIsTheFirstRobotOfTheParameters) {
  EXPECT_EQ(choice({}), "CONFLICT") << "no robot is configured";
  params_.robots = {{"right", "", "", ""}, {"left", "", "", ""}};
  EXPECT_EQ(choice({}), "right");
  robots_["right"].absent = true;
  EXPECT_EQ(choice({}), "NOT_READY") << "an answer about another robot would be wrong";
  EXPECT_TRUE(says(sentence_, "'right'")) << sentence_;
  EXPECT_EQ(choice({"shoulder"}), "left") << "an absent robot has no joints";
}

TEST_F(RobotChoice, IsNotAnotherRobotIfTheJointsOfOneCannotBeUsed) {
  const auto model = std::make_shared<LoadedRobot>(*robots_["left"].model);
  const auto read = std::make_shared<ReadDescription>(*model->read);
  const auto joints = std::make_shared<RobotJoints>(*read->joints);
  joints->kinematics.reset();
  joints->flaw = "a joint mimics itself";
  read->joints = joints;
  model->read = read;
  robots_["left"].model = model;
  EXPECT_EQ(choice({"shoulder"}), "CONFLICT");
  EXPECT_EQ(choice({"left/shoulder"}), "NOT_READY");
  EXPECT_TRUE(says(sentence_, "a joint mimics itself")) << sentence_;
}

TEST_F(RobotChoice, SaysWhyTheGroupsOfARobotCannotBeUsed) {
  add("left", "<robot name='r'><group><joint name='shoulder'/></group></robot>");
  EXPECT_EQ(choice({"left/shoulder"}), "left") << "its joints can be used";
  EXPECT_EQ(choice({}, "arm"), "UNKNOWN_ID");
  EXPECT_TRUE(says(sentence_, "no attribute 'name'")) << sentence_;
}

TEST_F(RobotChoice, RefusesARobotOfWhichNothingCanBeChecked) {
  const auto bare = std::make_shared<LoadedRobot>(*robots_["left"].model);
  bare->bodies.clear();
  robots_["left"].model = bare;
  EXPECT_EQ(choice({"left/shoulder"}), "NOT_READY");
  robots_.clear();
  EXPECT_EQ(choice({"shoulder"}), "NOT_READY");
}

}  // namespace
}  // namespace hgrid
