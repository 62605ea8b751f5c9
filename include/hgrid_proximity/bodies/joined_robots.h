// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

#include <string>
#include <vector>

#include "hgrid_proximity/bodies/robot_model.h"

namespace hgrid {

/// One of several robots that move at the same time.
struct JoinedRobot {
  std::string name;                         ///< name of the robot in the snapshot, see Body::robot
  const RobotModel* model = nullptr;        ///< its links and joints; not null; joinRobots() copies it
  Pose world_from_root = Pose::Identity();  ///< pose of its root link in the world [m], the same in all states
};

/// Returns several robots as one model, so that StateChecker can check all of them. Names of robots must differ.
///
/// The root link of the result is the world; its name is empty. Fixed joints connect the root links of the robots to
/// it. The link "hand" and the joint "elbow" of the robot "left" become "left/hand" and "left/elbow". The variables of
/// the first robot come first, then those of the next one. findRigidGroups() was called for the result.
RobotModel joinRobots(const std::vector<JoinedRobot>& robots);

}  // namespace hgrid
