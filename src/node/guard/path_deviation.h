// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

#include <string>
#include <vector>

#include "hgrid_proximity/bodies/kinematics.h"
#include "node/guard/robot_path.h"
#include "node/tick/tick.h"

namespace hgrid {

/// Returns the value of a variable that is nearest to an expected value and means the same as `present`. If its joint
/// turns freely, the result may differ from `present` by full turns.
double nearestTo(double expected, double present, const JointVariable& variable);

/// Returns a sentence that names a joint that is not where the path says; empty: all joints are.
/// @param present  [rad or m] where the joints of the robot are: one value for each variable
/// @param time     [ROS time] when they are there
/// @param most     [rad or m] how far a joint may be from its path
/// @throws Refusal unknown_id for a joint that the robot does not have
std::string deviationOf(const RobotPath& path, const LoadedRobot& robot, const std::vector<double>& present, Time time,
                        double most);

}  // namespace hgrid
