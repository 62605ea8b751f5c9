// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#include "hgrid_proximity/bodies/joint_groups.h"

#include <gtest/gtest.h>

#include "test/support/models.h"
#include "test/support/refusals.h"

namespace hgrid {
namespace {

using test::addLink;
using test::refusalOf;
using test::says;
using Names = std::vector<std::string>;

/// Two arms on a column that slides, each with a hand on a fixed flange. The fingers of the left hand mimic each other.
RobotModel twoArms() {
  RobotModel model;
  model.name = "robot";
  addLink(model, "base", -1);
  addLink(model, "column", 0, JointKind::prismatic);
  addLink(model, "left", 1, JointKind::revolute);
  addLink(model, "left_flange", 2, JointKind::fixed);
  addLink(model, "left_hand", 3, JointKind::revolute);
  addLink(model, "right", 1, JointKind::revolute);
  addLink(model, "right_hand", 5, JointKind::revolute);
  addLink(model, "finger", 4, JointKind::prismatic);
  addLink(model, "other_finger", 4, JointKind::prismatic);
  model.links.back().mimic = "finger_joint";
  addLink(model, "cart", 0, JointKind::planar);
  findRigidGroups(model);
  return model;
}

JointGroups groupsOf(const std::vector<JointGroup>& groups, JointKind kind = JointKind::floating) {
  return {groups, {{"world_joint", kind, "odom", "base"}}};
}

/// Returns the variables of the first group.
std::optional<Names> variables(const JointGroups& groups) {
  return variablesOf(groups.groups.front().name, groups, twoArms());
}

TEST(JointGroups, ContainJointsLinksChainsAndOtherGroups) {
  JointGroup group{"all", {"right_joint", "left_flange_joint"}, {"cart"}, {{"column", "left_hand"}}, {"fingers"}};
  const JointGroup fingers{"fingers", {"finger_joint", "other_finger_joint"}, {}, {}, {}};
  EXPECT_EQ(variables(groupsOf({group, fingers})),
            Names({"left_joint", "left_hand_joint", "right_joint", "finger_joint", "cart_joint/x", "cart_joint/y",
                   "cart_joint/theta"}));
  EXPECT_EQ(variables(groupsOf({fingers})), Names({"finger_joint"})) << "a joint that mimics another has no variable";
  group = {"across", {}, {}, {{"left_hand", "right_hand"}}, {}};
  EXPECT_EQ(variables(groupsOf({group})), Names({"left_joint", "left_hand_joint", "right_joint", "right_hand_joint"}))
      << "the chain goes over the link from which both ends descend";
}

TEST(JointGroups, MayContainEachOther) {
  std::vector<JointGroup> groups{{"first", {"left_joint"}, {}, {}, {"last"}}};
  for (int i = 0; i < 100000; ++i) {
    const std::string next = i == 99999 ? "last" : "group" + std::to_string(i + 1);
    groups.push_back({"group" + std::to_string(i), {}, {}, {}, {next, next}});
  }
  groups.push_back({"last", {"right_joint"}, {}, {}, {"group0", "first", "last"}});
  EXPECT_EQ(variables(groupsOf(groups)), Names({"left_joint", "right_joint"}));
}

TEST(JointGroups, AVirtualJointThatMovesMovesTheWholeRobot) {
  const JointGroup by_joint{"whole", {"world_joint", "left_joint"}, {}, {}, {}};
  const JointGroup by_link{"whole", {"left_joint"}, {"base"}, {}, {}};
  for (const JointGroup& group : {by_joint, by_link}) {
    EXPECT_EQ(variables(groupsOf({group})), std::nullopt);
    EXPECT_EQ(variables(groupsOf({group}, JointKind::planar)), std::nullopt);
    EXPECT_EQ(variables(groupsOf({group}, JointKind::fixed)), Names({"left_joint"}));
  }
}

TEST(JointGroups, AreRefusedByNameIfTheyNameWhatTheRobotDoesNotHave) {
  std::string sentence;
  const auto code = [&](const JointGroup& group) {
    return refusalOf([&] { variables(groupsOf({group})); }, &sentence);
  };
  EXPECT_EQ(code({"arm", {"wrist_joint"}, {}, {}, {}}), Code::unknown_id);
  EXPECT_TRUE(says(sentence, "'arm'") && says(sentence, "'wrist_joint'")) << sentence;
  EXPECT_EQ(code({"arm", {}, {"wrist"}, {}, {}}), Code::unknown_id);
  EXPECT_TRUE(says(sentence, "'arm'") && says(sentence, "'wrist'")) << sentence;
  EXPECT_EQ(code({"arm", {}, {}, {{"column", "tool"}}, {}}), Code::unknown_id);
  EXPECT_TRUE(says(sentence, "'tool'")) << sentence;
  EXPECT_EQ(code({"arm", {}, {}, {}, {"hand"}}), Code::unknown_id);
  EXPECT_TRUE(says(sentence, "'hand'") && says(sentence, "its groups are arm")) << sentence;
  EXPECT_EQ(code({"arm", {"left_flange_joint"}, {}, {}, {}}), Code::unsupported) << "nothing can move";
  EXPECT_EQ(refusalOf([] { variablesOf("arm", {}, twoArms()); }, &sentence), Code::unknown_id);
  EXPECT_TRUE(says(sentence, "it has no groups")) << sentence;
}

}  // namespace
}  // namespace hgrid
