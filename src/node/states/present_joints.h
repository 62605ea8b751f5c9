// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

#include <map>
#include <optional>
#include <string>
#include <vector>

#include "node/sources/robot_source.h"
#include "node/tf/transform_lookup.h"

namespace hgrid {

/// Returns a value for each variable of a robot (see JointVariable): the given value, or else the one that follows from
/// the poses of the links on tf.
/// @param robot      its joints must be known (RobotJoints::kinematics)
/// @param given      values, by name of the variable
/// @param max_apart  [s] how much the time of a pose may differ from `time`
/// @throws Refusal unknown_frame, extrapolation if the pose of a link is not known at this time
std::vector<double> presentJoints(const LoadedRobot& robot, const std::map<std::string, double>& given,
                                  const TransformLookup& transforms, Time time, double max_apart);

/// Returns the pose of the root link of a robot in the world, if the snapshot cannot have it, because no body of the
/// robot is rigidly connected to the root link. nullopt: the snapshot can have it.
/// @throws Refusal as presentJoints()
std::optional<Pose> rootWithoutBody(const LoadedRobot& robot, const std::string& world_frame,
                                    const TransformLookup& transforms, Time time, double max_apart);

}  // namespace hgrid
