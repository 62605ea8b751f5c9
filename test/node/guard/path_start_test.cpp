// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#include "src/node/guard/path_start.h"

#include <gtest/gtest.h>

#include <cmath>

#include "hgrid_proximity/adapters/urdf.h"
#include "src/node/guard/path_deviation.h"

namespace hgrid {
namespace {

const char* const kFourJoints =
    "<robot name='r'><link name='base'/><link name='a'/><link name='b'/><link name='c'/><link name='d'/>"
    "<joint name='free' type='continuous'><parent link='base'/><child link='a'/></joint>"
    "<joint name='wide' type='revolute'><parent link='base'/><child link='b'/>"
    "<limit lower='-6.28' upper='6.28' effort='1' velocity='1'/></joint>"
    "<joint name='followed' type='continuous'><parent link='base'/><child link='c'/></joint>"
    "<joint name='follower' type='continuous'><parent link='base'/><child link='d'/><mimic joint='followed' "
    "multiplier='0.5'/></joint></robot>";

class PathStart : public ::testing::Test {
 protected:
  PathStart() {
    const auto read = std::make_shared<ReadDescription>();
    read->model = readUrdf(kFourJoints, nullptr);
    read->joints = std::make_shared<const RobotJoints>(read->model, nullptr, DescriptionLimits{});
    robot_.name = "robot";
    robot_.read = read;
  }
  static RobotPath path(const std::vector<double>& seconds, const std::vector<double>& positions) {
    RobotPath path;
    path.robot = "robot";
    path.joints = {"free"};
    path.positions = positions;
    for (const double second : seconds) path.times.push_back(timeAt(second));
    return path;
  }
  static Time timeAt(double second) { return Time(std::llround(1e9 * second)); }
  const JointVariable& variable(const char* name) const {
    const Kinematics& kinematics = *robot_.read->joints->kinematics;
    return kinematics.variables()[std::size_t(kinematics.find(name))];
  }
  /// Returns values for all variables, 0 except for one.
  std::vector<double> present(const char* name, double value) const {
    std::vector<double> values(3);
    values[std::size_t(robot_.read->joints->kinematics->find(name))] = value;
    return values;
  }
  std::string deviation(const char* joint, double expected, double value) const {
    RobotPath path = PathStart::path({1.0}, {expected});
    path.joints = {joint};
    return deviationOf(path, robot_, present(joint, value), timeAt(1.0), 0.1);
  }

  LoadedRobot robot_;
};

/// Claim: full turns mean the same only for a joint that turns freely.
TEST_F(PathStart, ComparesAnglesUpToFullTurnsWhereTheyMeanTheSame) {
  EXPECT_NEAR(nearestTo(7.0, 7.0 - 4.0 * M_PI, variable("free")), 7.0, 1e-9);
  EXPECT_NEAR(nearestTo(4.0, 4.0 - 2.0 * M_PI, variable("wide")), 4.0 - 2.0 * M_PI, 1e-9);
  EXPECT_NEAR(nearestTo(2.0 * M_PI, 0.0, variable("followed")), 0.0, 1e-9);
  EXPECT_EQ(deviation("free", 7.0, 7.0 - 4.0 * M_PI), "");
  EXPECT_EQ(deviation("wide", 4.0, 4.0), "");
  EXPECT_NE(deviation("wide", 4.0, 4.0 - 2.0 * M_PI), "");
  EXPECT_NE(deviation("followed", 2.0 * M_PI, 0.0), "");
}

TEST_F(PathStart, IsWhereTheRobotStands) {
  RobotPath path = PathStart::path({5.0}, {4.0});
  addStart(path, timeAt(1.0), timeAt(1.0), robot_, present("free", -2.0), nullptr);
  EXPECT_EQ(path.times, (std::vector<Time>{timeAt(1.0), timeAt(5.0)}));
  EXPECT_NEAR(path.positions[0], 2.0 * M_PI - 2.0, 1e-9);  // the shorter way
  RobotPath begun = PathStart::path({0.5, 5.0}, {4.0, 5.0});
  addStart(begun, timeAt(1.0), timeAt(1.0), robot_, present("free", -2.0), nullptr);
  EXPECT_EQ(begun.points(), 2u);
}

/// Claim: until a path starts, the robot continues its earlier path.
TEST_F(PathStart, ContinuesTheEarlierPath) {
  const RobotPath before = path({0.0, 2.0, 10.0}, {0.0, 2.0, -6.0});
  RobotPath next = path({5.0, 8.0}, {0.0, 1.0});
  addStart(next, timeAt(1.0), timeAt(4.0), robot_, present("free", 1.1), &before);
  EXPECT_EQ(next.times, (std::vector<Time>{timeAt(1.0), timeAt(2.0), timeAt(4.0), timeAt(5.0), timeAt(8.0)}));
  EXPECT_EQ(next.positions, (std::vector<double>{1.1, 2.0, 0.0, 0.0, 1.0}));
  RobotPath at_once = path({4.0, 8.0}, {3.0, 1.0});  // it begins elsewhere than the earlier path has led
  addStart(at_once, timeAt(1.0), timeAt(4.0), robot_, present("free", 1.1), &before);
  EXPECT_EQ(at_once.times[2], timeAt(4.0) - Time(1));
  EXPECT_NEAR(at_once.positions[2], 0.0, 1e-6);
}

}  // namespace
}  // namespace hgrid
