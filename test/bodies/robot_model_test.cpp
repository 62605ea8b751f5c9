// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#include "hgrid_proximity/bodies/robot_model.h"

#include <gtest/gtest.h>

#include "test/support/models.h"

namespace hgrid {
namespace {

using test::addLink;
using test::Random;

const double kInfinity = std::numeric_limits<double>::infinity();

TEST(RobotModel, FindsLinksByName) {
  RobotModel model;
  addLink(model, "base", -1);
  addLink(model, "tool", 0);
  EXPECT_EQ(model.find("tool"), 1);
  EXPECT_EQ(model.find("base"), 0);
  EXPECT_EQ(model.find("too"), -1);
  EXPECT_EQ(RobotModel{}.find(""), -1);
}

TEST(RigidGroups, AreTheLinksJoinedByFixedJoints) {
  for (unsigned seed = 1; seed <= 200; ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    Random random(seed);
    RobotModel model = test::randomModel(random, random.between(1, 30));
    findRigidGroups(model);  // a second call must not change the result
    // For each link: its pose in the root frame with all joints at 0, and the topmost link of its rigid group.
    std::vector<Pose> root_from_link;
    std::vector<std::uint32_t> top;
    for (std::uint32_t i = 0; i < model.links.size(); ++i) {
      const RobotLink& link = model.links[i];
      const auto parent = std::size_t(std::max(link.parent, 0));
      root_from_link.push_back(link.parent < 0 ? Pose::Identity() : root_from_link[parent] * link.parent_from_joint);
      top.push_back(link.parent >= 0 && link.joint_kind == JointKind::fixed ? top[parent] : i);
    }
    for (std::uint32_t i = 0; i < model.links.size(); ++i) {
      const RobotLink& link = model.links[i];
      ASSERT_LT(link.rigid_group, model.group_roots.size());
      ASSERT_EQ(model.group_roots[link.rigid_group], top[i]);
      const Pose expected = root_from_link[top[i]].inverse() * root_from_link[i];
      ASSERT_TRUE(link.group_from_link.isApprox(expected, 1e-12));
      for (std::uint32_t j = 0; j < i; ++j) ASSERT_EQ(link.rigid_group == model.links[j].rigid_group, top[i] == top[j]);
    }
  }
}

/// Returns a robot with one joint of this kind. A sphere of radius 0.1 m is 0.5 m away from the joint.
RobotModel pendulum(JointKind kind) {
  RobotModel model;
  addLink(model, "base", -1);
  addLink(model, "bob", 0, kind);
  RobotLink& bob = model.links[1];
  bob.parent_from_joint.translation() << 7, 0, 0;
  bob.axis = Eigen::Vector3d::UnitZ();
  bob.max_velocity = 2.0;
  bob.shapes[0].body_from_shape.translation() << 0.5, 0, 0;
  return model;
}

TEST(SpeedBound, OfOneJointIsTight) {
  EXPECT_DOUBLE_EQ(speedBound(pendulum(JointKind::revolute), 1), 2.0 * 0.6);
  EXPECT_DOUBLE_EQ(speedBound(pendulum(JointKind::prismatic), 1), 2.0);
  EXPECT_EQ(speedBound(pendulum(JointKind::fixed), 1), 0.0);
  EXPECT_EQ(speedBound(pendulum(JointKind::revolute), 0), 0.0) << "the root link does not move in its own frame";
  RobotModel padded = pendulum(JointKind::revolute);
  padded.links[1].shapes[0].padding = 0.25;
  EXPECT_DOUBLE_EQ(speedBound(padded, 1), 2.0 * 0.85) << "the bound must include the padding";
}

TEST(SpeedBound, IsInfiniteWhereAJointHasNoLimit) {
  for (const JointKind kind : {JointKind::revolute, JointKind::prismatic}) {
    RobotModel model = pendulum(kind);
    model.links[1].max_velocity = 0.0;
    EXPECT_EQ(speedBound(model, 1), kInfinity);
  }
  EXPECT_EQ(speedBound(pendulum(JointKind::planar), 1), kInfinity);
  EXPECT_EQ(speedBound(pendulum(JointKind::floating), 1), kInfinity);
}

TEST(SpeedBound, ALinkWithoutShapesHasABoundThatIsANumber) {
  RobotModel model = pendulum(JointKind::revolute);
  model.links[1].max_velocity = 0.0;
  addLink(model, "frame", 1, JointKind::revolute, false);
  EXPECT_FALSE(std::isnan(speedBound(model, 2)));
  model.links[1].shapes.clear();
  addLink(model, "next", 0);
  EXPECT_FALSE(std::isnan(speedBound(model, 1)));
}

// A prismatic joint without limits can move a link arbitrarily far from the revolute joint that rotates the link.
TEST(SpeedBound, IsInfiniteWhereAnEndlessSlideIsTurned) {
  RobotModel model = pendulum(JointKind::revolute);
  addLink(model, "slide", 1, JointKind::prismatic);
  model.links[2].max_velocity = 1.0;
  EXPECT_EQ(speedBound(model, 2), kInfinity);
  model.links[2].lower = -0.5, model.links[2].upper = 0.25;
  EXPECT_LT(speedBound(model, 2), kInfinity);
}

/// Claim: a joint without a limit hides nothing of what the joints with limits add.
TEST(LinkSpeed, CountsTheJointsWithLimitsBesideAJointWithoutOne) {
  RobotModel model = pendulum(JointKind::revolute);
  EXPECT_TRUE(linkSpeed(model, 1, 0.6).is_bound);
  for (const JointKind kind : {JointKind::revolute, JointKind::prismatic, JointKind::planar, JointKind::floating}) {
    RobotModel longer = model;
    addLink(longer, "flag", 1, kind);
    longer.links[2].parent_from_joint.translation() << 1, 0, 0;
    const LinkSpeed flag = linkSpeed(longer, 2, 0.5);
    EXPECT_DOUBLE_EQ(flag.limited, 2.0 * 1.5) << "kind " << int(kind);
    EXPECT_FALSE(flag.is_bound);
  }
  model.links[1].max_velocity = 0.0;
  addLink(model, "saw", 1);
  model.links[2].max_velocity = 30.0;
  EXPECT_DOUBLE_EQ(linkSpeed(model, 2, 0.5).limited, 15.0);
  EXPECT_EQ(speedBound(model, 2, 0.5), kInfinity);
}

/// Returns a lift of three stages. The second one goes twice as far as the first one, the third one three times as far
/// as the second one; their own limits are smaller than that. An arm of 0.9 m and a ball of 0.1 m turn at the end.
RobotModel telescope() {
  RobotModel model;
  addLink(model, "base", -1, JointKind::fixed, false);
  for (int stage = 1; stage <= 3; ++stage) {
    addLink(model, std::to_string(stage), stage - 1, JointKind::prismatic, false);
    RobotLink& link = model.links.back();
    link.max_velocity = 0.5, link.upper = 1.0;
    if (stage > 1) link.mimic = std::to_string(stage - 1) + "_joint", link.mimic_multiplier = stage == 2 ? -2.0 : 3.0;
    if (stage == 3) link.mimic_offset = -0.25;
  }
  addLink(model, "arm", 3);
  model.links.back().shapes[0].body_from_shape.translation() << 0.9, 0, 0;
  model.links.back().max_velocity = 1.0;
  return model;
}

TEST(SpeedBound, OfAMimickingJointIsThatOfTheJointItFollows) {
  RobotModel model = telescope();
  EXPECT_DOUBLE_EQ(speedBound(model, 4), 0.5 + 2 * 0.5 + 6 * 0.5 + 1.0);
  EXPECT_DOUBLE_EQ(speedBound(model, 4, 3.0), 0.5 + 2 * 0.5 + 6 * 0.5 + 3.0) << "something that it carries reaches out";
  model.links[3].joint_kind = JointKind::revolute;  // the last stage turns instead
  EXPECT_DOUBLE_EQ(speedBound(model, 4), 0.5 + 2 * 0.5 + 6 * 0.5 * 1.0 + 1.0);
  model.links[1].joint_kind = JointKind::revolute;  // it turns the stage that slides as far as 2 m
  EXPECT_DOUBLE_EQ(speedBound(model, 4), 0.5 * (1.0 + 2.0) + 2 * 0.5 + 6 * 0.5 * 1.0 + 1.0);
}

TEST(SpeedBound, OfASlideThatMimicsCountsItsOffset) {
  RobotModel model = telescope();
  model.links[1].joint_kind = model.links[2].joint_kind = JointKind::revolute;
  // The joints of stages 1 and 2 turn the arm and the stage that slides as far as 6 * 1 m + 0.25 m.
  EXPECT_DOUBLE_EQ(speedBound(model, 4), (0.5 + 2 * 0.5) * (1.0 + 6.25) + 6 * 0.5 + 1.0);
}

TEST(SpeedBound, OfAJointThatFollowsNothingKnownIsInfinite) {
  RobotModel model = telescope();
  model.links[1].max_velocity = 0.0;
  EXPECT_EQ(speedBound(model, 4), kInfinity) << "the joint that the others follow has no limit";
  model = telescope();
  model.links[2].mimic = "nobody";
  EXPECT_EQ(speedBound(model, 4), kInfinity);
  model = telescope();
  model.links[1].mimic = "3_joint";
  EXPECT_EQ(speedBound(model, 4), kInfinity) << "the three joints follow each other in a circle";
  model = telescope();
  model.links[1].max_velocity = 0.0;
  model.links[2].mimic_multiplier = 0.0;
  EXPECT_EQ(speedBound(model, 4), kInfinity);
  model.links[1].max_velocity = 0.5;
  EXPECT_DOUBLE_EQ(speedBound(model, 4), 0.5 + 1.0) << "stages 2 and 3 stay where they are";
}

/// Returns the largest speed [m/s] that was found for points on the shapes of the last link of a chain. Tries random
/// positions and velocities of the joints.
double fastestPoint(const RobotModel& model, Random& random) {
  struct Turn {
    bool revolute;
    Eigen::Vector3d origin, axis;
    double rate;
  };
  std::vector<Turn> turns;
  Pose root_from_link = Pose::Identity();
  for (const RobotLink& link : model.links) {
    root_from_link = root_from_link * link.parent_from_joint;
    const bool revolute = link.joint_kind == JointKind::revolute;
    if (link.parent < 0 || link.joint_kind == JointKind::fixed) continue;
    const bool at_end = random.chance(0.5);  // the largest speeds occur at the limits
    const double position =
        at_end ? (random.chance(0.5) ? link.lower : link.upper) : random.uniform(link.lower, link.upper);
    const double rate = random.chance(0.5) ? link.max_velocity : random.uniform(-1, 1) * link.max_velocity;
    turns.push_back({revolute, root_from_link.translation(), root_from_link.linear() * link.axis, rate});
    if (revolute) {
      root_from_link.linear() = root_from_link.linear() * Eigen::AngleAxisd(position, link.axis).toRotationMatrix();
    } else {
      root_from_link.translation() += root_from_link.linear() * (position * link.axis);
    }
  }
  double fastest = 0;
  for (const BodyShape& shape : model.links.back().shapes) {
    for (int i = 0; i < 10; ++i) {
      const Eigen::Vector3d corner =
          0.5 *
          Eigen::Vector3d(shape.shape.dimensions().data())
              .cwiseProduct(Eigen::Vector3d(random.below(2) * 2 - 1, random.below(2) * 2 - 1, random.below(2) * 2 - 1));
      const Eigen::Vector3d point = root_from_link * shape.body_from_shape * corner;
      Eigen::Vector3d speed = Eigen::Vector3d::Zero();
      for (const Turn& turn : turns) {
        speed += turn.rate * (turn.revolute ? Eigen::Vector3d(turn.axis.cross(point - turn.origin)) : turn.axis);
      }
      fastest = std::max(fastest, speed.norm());
    }
  }
  return fastest;
}

TEST(SpeedBound, NoPointOfAChainIsEverFaster) {
  double closest = 0;
  for (unsigned seed = 1; seed <= 300; ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    Random random(seed);
    RobotModel model;
    for (int i = 0, count = random.between(2, 7); i < count; ++i) {
      const JointKind kinds[] = {JointKind::fixed, JointKind::revolute, JointKind::prismatic};
      addLink(model, std::to_string(i), i - 1, kinds[random.below(3)]);
      RobotLink& link = model.links.back();
      if (i > 0) link.parent_from_joint = test::randomPose(random, 1.0);
      link.axis = test::randomPose(random, 0).linear().col(0);
      link.max_velocity = random.uniform(0.1, 3.0);
      link.lower = random.uniform(-2, 0), link.upper = random.uniform(0.1, 2);
      link.shapes = {
          test::shapeOf(Shape::box({random.uniform(0.1, 1), random.uniform(0.1, 1), random.uniform(0.1, 1)}))};
      link.shapes[0].body_from_shape = test::randomPose(random, 0.5);
    }
    const double bound = speedBound(model, std::uint32_t(model.links.size()) - 1);
    for (int i = 0; i < 100; ++i) {
      const double fastest = fastestPoint(model, random);
      ASSERT_LE(fastest, bound * (1 + 1e-12));
      if (bound > 0) closest = std::max(closest, fastest / bound);
    }
  }
  EXPECT_GT(closest, 0.8) << "the bound is far larger than the speeds that occur";
}

}  // namespace
}  // namespace hgrid
