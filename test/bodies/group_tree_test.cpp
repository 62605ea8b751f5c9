// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#include "src/bodies/group_tree.h"

#include <gtest/gtest.h>

#include "test/support/models.h"

namespace hgrid {
namespace {

using Names = std::vector<std::string>;

class HumanoidGroups : public ::testing::Test {
 protected:
  std::uint32_t groupOf(const std::string& link) const {
    return model_.links.at(std::size_t(model_.find(link))).rigid_group;
  }
  /// Returns the joints between the rigid groups of two links. Checks that the order of the two links does not matter.
  Names jointsBetween(const std::string& first, const std::string& second) const {
    const Names joints = groups_.jointsBetween(groupOf(first), groupOf(second));
    EXPECT_EQ(groups_.jointsBetween(groupOf(second), groupOf(first)), joints);
    return joints;
  }

  const RobotModel model_ = test::humanoid();
  const GroupTree groups_{model_};
};

TEST_F(HumanoidGroups, AdjacentGroupsNameTheJointsBetweenThemFromTheUpperOneDown) {
  EXPECT_EQ(jointsBetween("left_upper_arm_shape", "left_forearm_shape"), Names({"left_forearm_joint"}));
  EXPECT_EQ(jointsBetween("pelvis", "torso"), Names({"waist_joint", "torso_joint"}));
  EXPECT_EQ(jointsBetween("torso", "right_upper_arm"),
            Names({"right_shoulder_swing_joint", "right_shoulder_lift_joint", "right_upper_arm_joint"}));
  EXPECT_EQ(jointsBetween("right_shoulder_swing", "right_upper_arm"),
            Names({"right_shoulder_lift_joint", "right_upper_arm_joint"}));
}

TEST_F(HumanoidGroups, OtherGroupsHaveNoJointsBetweenThem) {
  EXPECT_EQ(jointsBetween("torso", "head"), Names())
      << "the joints of the neck are 6 cm apart, so they are not one joint";
  EXPECT_EQ(jointsBetween("torso", "left_forearm"), Names()) << "the upper arm is between them";
  EXPECT_EQ(jointsBetween("left_hand", "right_hand"), Names());
  EXPECT_EQ(jointsBetween("left_shoulder_swing", "right_shoulder_swing"), Names());
  EXPECT_EQ(jointsBetween("torso", "torso_shape"), Names()) << "both links are in one group";
}

TEST_F(HumanoidGroups, TheAdjacentGroupsAboveAreListedFromTheNearest) {
  EXPECT_EQ(
      groups_.adjacentAbove(groupOf("left_upper_arm")),
      std::vector<std::uint32_t>({groupOf("left_shoulder_lift"), groupOf("left_shoulder_swing"), groupOf("torso")}));
  EXPECT_EQ(groups_.adjacentAbove(groupOf("head")), std::vector<std::uint32_t>({groupOf("neck")}));
  EXPECT_TRUE(groups_.adjacentAbove(groupOf("pelvis")).empty()) << "nothing is above the root group";
  EXPECT_EQ(groups_.size(), 17u);
}

}  // namespace
}  // namespace hgrid
