// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#include "hgrid_proximity/bodies/self_pairs.h"

#include <gtest/gtest.h>

#include "test/support/models.h"

namespace hgrid {
namespace {

using test::addLink;

TEST(SelfPairs, AreCountedByOriginForLinksWithGeometry) {
  RobotModel model = test::humanoid();
  addLink(model, "badge", model.find("torso"), JointKind::fixed);
  findRigidGroups(model);
  LinkRules rules;
  rules.disabled = {{"left_hand_shape", "right_hand_shape", "Never"}, {"pelvis_shape", "torso_shape", "Adjacent"}};
  rules.disabled_default = {"neck"};  // this link has no geometry, so the rule has no effect
  rules.enabled = {{"left_forearm_shape", "left_hand_shape", ""}};
  const SelfPairs counts = countSelfPairs(model, test::matrixOf(model, rules));
  EXPECT_EQ(counts.links, 10u);
  EXPECT_EQ(counts.pairs, 45u);
  EXPECT_EQ(counts.rigid, 1u) << "the pair of badge and torso";
  EXPECT_EQ(counts.adjacent, 7u - 1u - 1u + 3u)
      << "an SRDF disables one of the 7 pairs and enables one; the badge in the torso's group adds 3";
  EXPECT_EQ(counts.srdf, 2u);
  EXPECT_FALSE(counts.allOff());
  EXPECT_EQ(text(counts), "11 of the 45 pairs of its 10 links with geometry are off (1 rigid, 8 adjacent, 2 by SRDF)");
}

TEST(SelfPairs, AllAreOffOnlyWhereThereArePairs) {
  RobotModel model;
  addLink(model, "base", -1);
  findRigidGroups(model);
  EXPECT_FALSE(countSelfPairs(model, test::matrixOf(model)).allOff()) << "one link makes no pair";
  addLink(model, "arm", 0);
  findRigidGroups(model);
  EXPECT_TRUE(countSelfPairs(model, test::matrixOf(model)).allOff());
  addLink(model, "hand", 1);
  findRigidGroups(model);
  EXPECT_FALSE(countSelfPairs(model, test::matrixOf(model)).allOff()) << "the pair of base and hand is not off";
}

TEST(SelfPairs, OfTwoLinksLookWrongOnlyIfTheSrdfSwitchesThemOff) {
  RobotModel model;
  addLink(model, "base", -1);
  addLink(model, "belt", 0);
  findRigidGroups(model);
  EXPECT_FALSE(countSelfPairs(model, test::matrixOf(model)).looksWrong()) << "a joint connects the two links";
  LinkRules rules;
  rules.disabled = {{"base", "belt", "Never"}};
  EXPECT_TRUE(countSelfPairs(model, test::matrixOf(model, rules)).looksWrong());
  addLink(model, "cover", 0, JointKind::fixed);
  addLink(model, "motor", 0, JointKind::fixed);
  model.links[1].joint_kind = JointKind::fixed;
  findRigidGroups(model);
  EXPECT_TRUE(countSelfPairs(model, test::matrixOf(model)).looksWrong()) << "all pairs of four links are off";
}

TEST(SelfPairs, VisualGeometryThatIsUsedCounts) {
  RobotModel model;
  addLink(model, "base", -1);
  addLink(model, "cover", 0, JointKind::revolute, false);
  findRigidGroups(model);
  EXPECT_EQ(countSelfPairs(model, test::matrixOf(model)).links, 1u);
  model.links[1].uses_visual = true;
  EXPECT_EQ(countSelfPairs(model, test::matrixOf(model)).links, 2u);
  EXPECT_EQ(countSelfPairs(model, test::matrixOf(model)).adjacent, 1u);
}

}  // namespace
}  // namespace hgrid
