// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

#include <vector>

#include "node/guard/robot_path.h"
#include "node/tick/tick.h"

namespace hgrid {

/// Adds to a path what the robot does before the first point. Until `start`, the robot continues its earlier path; a
/// joint that has none stays where it is. Then it moves to the first point.
/// @param start    [ROS time] not earlier than `now`
/// @param present  [rad or m] where the joints of the robot are: one value for each variable
/// @param before   the path that the robot has followed so far; null: none
void addStart(RobotPath& path, Time now, Time start, const LoadedRobot& robot, const std::vector<double>& present,
              const RobotPath* before);

}  // namespace hgrid
