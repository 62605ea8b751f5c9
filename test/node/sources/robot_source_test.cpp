// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
//
// Tests the speeds of the links of a robot. It needs no ROS master.
#include "src/node/robots/robot_source.h"

#include <gtest/gtest.h>

#include "test/support/models.h"

namespace hgrid {
namespace test {
namespace {

/// A robot "arm" with a turning link "hand", in the world frame. The hand is a sphere of radius 0.1 m, 1 m from the
/// joint, which turns at 4 rad/s.
class LinkSpeeds : public ::testing::Test {
 protected:
  LinkSpeeds() {
    params_.world_frame = robot_.root_frame = "world";
    params_.default_max_speed = 2.0;
    addLink(model_, "base", -1);
    addLink(model_, "hand", 0);
    model_.links[1].max_velocity = 4.0;
    model_.links[1].shapes[0].body_from_shape.translation().x() = 1.0;
  }
  Body bodyOf(std::uint32_t link) const {
    Body body;
    body.name = "arm/" + model_.links[link].name;
    body.link = link;
    body.shapes = model_.links[link].shapes;
    return body;
  }

  Params params_;
  LoadedRobot robot_;
  RobotModel model_;
};

TEST_F(LinkSpeeds, AreThoseOfTheJointsAndOfTheRoot) {
  EXPECT_DOUBLE_EQ(expectedSpeed(robot_, model_, 1, 1.1, params_), 4.0 * 1.1);
  robot_.root_frame = "cart";
  EXPECT_DOUBLE_EQ(expectedSpeed(robot_, model_, 1, 1.1, params_), 4.0 * 1.1 + 2.0);
}

/// Claim: a joint without a limit is not slower than the others let the link be.
TEST_F(LinkSpeeds, BelowAJointWithoutLimitAreNotSlowerThanTheOtherJointsAllow) {
  addLink(model_, "knob", 1);
  EXPECT_DOUBLE_EQ(expectedSpeed(robot_, model_, 2, 0.5, params_), 4.0 * 0.5 + 2.0);
  model_.links[1].max_velocity = 0.0;
  EXPECT_DOUBLE_EQ(expectedSpeed(robot_, model_, 2, 0.5, params_), 2.0) << "nothing else is known";
}

/// Claim: the guaranteed speed is that of the shapes with the padding that parameters give them.
TEST_F(LinkSpeeds, CountThePaddingOfTheBody) {
  Body hand = bodyOf(1);
  hand.shapes[0].padding = 0.5;
  setSpeeds(robot_, model_, params_, hand);
  EXPECT_DOUBLE_EQ(hand.max_speed, 4.0 * 1.6);
  EXPECT_DOUBLE_EQ(hand.speed_bound, 4.0 * 1.6);
}

}  // namespace
}  // namespace test
}  // namespace hgrid
