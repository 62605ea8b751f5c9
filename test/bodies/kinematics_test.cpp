// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#include "hgrid_proximity/bodies/kinematics.h"

#include <gtest/gtest.h>

#include <cmath>

#include "geometry/sine_cosine.h"
#include "test/support/joints.h"
#include "test/support/refusals.h"

namespace hgrid {
namespace {

using test::JointOracle;
using test::Random;
using test::refusalOf;
using test::says;

TEST(SineCosine, AgreesWithTheCLibraryUpToTheLargestAngle) {
  Random random(1);
  for (int i = 0; i < 20000; ++i) {
    const double size = i % 3 == 0 ? 1.0 : i % 3 == 1 ? 100.0 : kLargestAngle;
    double angle = random.uniform(-size, size);
    if (i % 5 == 0) angle = random.between(-40, 40) * std::acos(0.0) + random.uniform(-1e-9, 1e-9);
    if (i == 0) angle = -0.0;
    FourDoubles angles = fourDoubles(0.25);
    angles.set(std::size_t(i) % 4, angle);
    const SineCosine found = sineCosine(angles);
    EXPECT_NEAR(found.sine[std::size_t(i) % 4], std::sin(angle), 4e-16) << angle;
    EXPECT_NEAR(found.cosine[std::size_t(i) % 4], std::cos(angle), 4e-16) << angle;
    EXPECT_NEAR(found.sine[std::size_t(i + 1) % 4], std::sin(0.25), 4e-16);
  }
}

TEST(Kinematics, PlacesTheLinksOfRandomMechanismsLikeTheDefinitionsOfTheirJoints) {
  std::map<JointKind, int> kinds;
  int mimics = 0, chains = 0;
  for (unsigned seed = 1; seed <= 100; ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    Random random(seed);
    const RobotModel model = test::randomMechanism(random, random.between(1, 12), 0.5);
    const Kinematics kinematics(model);
    for (const RobotLink& link : model.links) {
      ++kinds[link.joint_kind];
      mimics += link.mimic.empty() ? 0 : 1;
      for (const RobotLink& master : model.links) {
        chains += !link.mimic.empty() && link.mimic == master.joint && !master.mimic.empty() ? 1 : 0;
      }
    }
    for (int i = 0; i < 10; ++i) {
      const std::vector<double> state = test::randomState(random, kinematics);
      const JointOracle oracle(model, kinematics, state);
      const std::vector<Pose> poses = kinematics.rootFromLinks(state);
      ASSERT_EQ(poses.size(), model.links.size());
      for (std::size_t link = 0; link < poses.size(); ++link) {
        EXPECT_LT((poses[link].matrix() - oracle.rootFromLink(int(link)).matrix()).norm(), 1e-13)
            << model.links[link].name;
      }
    }
  }
  EXPECT_EQ(kinds.size(), 5u);
  EXPECT_GT(mimics, 20);
  EXPECT_GT(chains, 0);
}

TEST(Kinematics, FindsTheValuesWithWhichLinksHaveTheirPoses) {
  int turned = 0;
  for (unsigned seed = 1; seed <= 100; ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    Random random(seed);
    const RobotModel model = test::randomMechanism(random, random.between(1, 12), 0.5);
    const Kinematics kinematics(model);
    const std::vector<double> state = test::randomState(random, kinematics);
    const std::vector<Pose> poses = kinematics.rootFromLinks(state);
    std::vector<double> values;
    for (std::size_t i = 0; i < model.links.size(); ++i) {
      const RobotLink& link = model.links[i];
      if (link.mimic.empty() && link.parent >= 0) {
        appendValues(link, poses[std::size_t(link.parent)].inverse() * poses[i], values);
      }
    }
    ASSERT_EQ(values.size(), state.size());
    const std::vector<Pose> again = kinematics.rootFromLinks(values);
    for (std::size_t i = 0; i < values.size(); ++i) {
      const JointVariable& variable = kinematics.variables()[i];
      const bool is_within = state[i] >= variable.lower && state[i] <= variable.upper;
      if (std::isfinite(variable.lower) && is_within) {
        EXPECT_NEAR(values[i], state[i], 1e-9) << variable.name << ": a joint with limits has the same value again";
      }
      turned += variable.is_angle && std::abs(values[i] - state[i]) > 1.0 ? 1 : 0;
    }
    for (std::size_t i = 0; i < poses.size(); ++i) {
      bool follows_turns = false;  // a joint that mimics a turned joint by a factor is elsewhere after a full turn
      for (int at = int(i); at >= 0; at = model.links[std::size_t(at)].parent) {
        follows_turns |= !model.links[std::size_t(at)].mimic.empty();
      }
      if (follows_turns) continue;
      EXPECT_LT((again[i].matrix() - poses[i].matrix()).norm(), 1e-9) << model.links[i].name;
    }
  }
  EXPECT_GT(turned, 10) << "angles beyond half a turn come back as others";
}

TEST(Kinematics, FindsAnAngleWithinTheLimitsOfItsJoint) {
  RobotModel model;
  test::addLink(model, "base", -1);
  test::addLink(model, "arm", 0, JointKind::revolute);
  RobotLink& link = model.links[1];
  const auto angle = [&](double turn, double lower, double upper) {
    link.lower = lower;
    link.upper = upper;
    std::vector<double> values;
    appendValues(link, link.parent_from_joint * Pose(Eigen::AngleAxisd(turn, link.axis)), values);
    return values.at(0);
  };
  EXPECT_NEAR(angle(4.0, 0.0, 6.0), 4.0, 1e-12);
  EXPECT_NEAR(angle(-4.0, -6.0, 0.0), -4.0, 1e-12);
  EXPECT_NEAR(angle(2.0, 0.0, 1.0), 2.0, 1e-12) << "no other turn is within the limits";
  EXPECT_NEAR(angle(4.0, 0.0, 0.0), 4.0 - 2.0 * M_PI, 1e-12) << "there are no limits";
}

RobotModel twoJoints() {
  RobotModel model;
  model.name = "robot";
  test::addLink(model, "base", -1);
  test::addLink(model, "arm", 0, JointKind::revolute);
  test::addLink(model, "hand", 1, JointKind::prismatic);
  findRigidGroups(model);
  return model;
}

TEST(Kinematics, NamesTheVariablesOfEachKindOfJoint) {
  RobotModel model = twoJoints();
  model.links[2].lower = -0.1;
  model.links[2].upper = 0.2;
  model.links[1].lower = -1.0;
  model.links[1].upper = 1.0;
  model.links[1].continuous = true;
  test::addLink(model, "cart", 0, JointKind::planar);
  test::addLink(model, "drone", 0, JointKind::floating);
  test::addLink(model, "plate", 0, JointKind::fixed);
  test::addLink(model, "follower", 0, JointKind::revolute);
  model.links.back().mimic = "arm_joint";
  findRigidGroups(model);
  const Kinematics kinematics(model);
  std::string names;
  for (const JointVariable& variable : kinematics.variables()) names += variable.name + " ";
  EXPECT_EQ(names,
            "arm_joint hand_joint cart_joint/x cart_joint/y cart_joint/theta drone_joint/trans_x drone_joint/trans_y "
            "drone_joint/trans_z drone_joint/rot_x drone_joint/rot_y drone_joint/rot_z drone_joint/rot_w ");
  EXPECT_EQ(kinematics.find("hand_joint"), 1);
  EXPECT_EQ(kinematics.find("plate_joint"), -1);
  EXPECT_TRUE(std::isinf(kinematics.variables()[0].lower)) << "a continuous joint has no limits";
  EXPECT_EQ(kinematics.variables()[1].lower, -0.1);
  EXPECT_TRUE(kinematics.variables()[4].is_angle);
  EXPECT_EQ(kinematics.variables()[10].quaternion, 8);
}

TEST(Kinematics, RefusesJointsThatMimicWrongly) {
  std::string sentence;
  RobotModel model = twoJoints();
  model.links[2].mimic = "shoulder";
  EXPECT_EQ(refusalOf([&] { Kinematics kinematics(model); }, &sentence), Code::unknown_id);
  EXPECT_TRUE(says(sentence, "hand_joint") && says(sentence, "shoulder"));
  model.links[2].mimic = "hand_joint";
  EXPECT_EQ(refusalOf([&] { Kinematics kinematics(model); }), Code::unsupported);
  model.links[1].mimic = "hand_joint";
  model.links[2].mimic = "arm_joint";
  EXPECT_EQ(refusalOf([&] { Kinematics kinematics(model); }), Code::unsupported);
  model = twoJoints();
  model.links[2].mimic = "arm_joint";
  model.links[2].mimic_multiplier = std::nan("");
  EXPECT_EQ(refusalOf([&] { Kinematics kinematics(model); }, &sentence), Code::nonfinite);
  EXPECT_TRUE(says(sentence, "nan"));
  model = twoJoints();
  test::addLink(model, "cart", 0, JointKind::planar);
  model.links[2].mimic = "cart_joint";
  findRigidGroups(model);
  EXPECT_EQ(refusalOf([&] { Kinematics kinematics(model); }), Code::unsupported);
}

}  // namespace
}  // namespace hgrid
