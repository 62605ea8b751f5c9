// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#include "src/node/robots/state_publisher.h"

#include <gtest/gtest.h>

#include "test/support/refusals.h"

namespace hgrid {
namespace test {
namespace {

/// Adds a link whose joint "<name>_joint" may follow the joint of another link.
void add(RobotModel& model, const std::string& name, JointKind kind, const std::string& followed = "") {
  RobotLink link;
  link.name = name;
  link.parent = model.links.empty() ? -1 : 0;
  link.joint = name + "_joint";
  link.joint_kind = kind;
  if (!followed.empty()) link.mimic = followed + "_joint";
  model.links.push_back(link);
}

TEST(StatePublisher, CannotSendPlanarAndFloatingJoints) {
  RobotModel model;
  add(model, "base", JointKind::floating);  // the root has no joint
  add(model, "plate", JointKind::planar);
  add(model, "drone", JointKind::floating);
  add(model, "arm", JointKind::revolute);
  add(model, "foot", JointKind::fixed);
  EXPECT_EQ(freeFrames(model, "left"), (std::set<std::string, std::less<>>{"left/plate", "left/drone"}));
}

TEST(StatePublisher, ComputesFollowersOnlyInTheOrderOfTheirNames) {
  RobotModel model;
  add(model, "base", JointKind::fixed);
  add(model, "m", JointKind::revolute);
  add(model, "b", JointKind::revolute, "m");
  add(model, "c", JointKind::revolute, "b");  // b comes before c
  add(model, "a", JointKind::revolute, "d");  // d comes after a
  add(model, "d", JointKind::revolute, "m");
  const auto unsent = unsentFrames(model, "");
  ASSERT_EQ(unsent.size(), 1u);
  EXPECT_EQ(unsent.begin()->first, "a");
  EXPECT_TRUE(says(unsent.begin()->second, "joint 'a_joint' follows 'd_joint', which itself follows a joint"));
}

}  // namespace
}  // namespace test
}  // namespace hgrid
