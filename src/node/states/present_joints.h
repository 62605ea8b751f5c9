// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

#include <map>
#include <optional>
#include <string>
#include <vector>

#include "node/tf/transform_lookup.h"
#include "node/tick/tick.h"

namespace hgrid {

/// Returns the link whose joint decides where a joint stands: its own link, or that of the joint that it mimics.
const RobotLink& masterOf(const RobotLink& link, const RobotModel& model);

/// Where the joints of a robot stand at the time of a tick.
struct PresentJoints {
  std::vector<double> values;  ///< one for each variable (see JointVariable)
  /// Why the joints may stand elsewhere, for example because a link is LOST; empty: they do not.
  std::string doubt;
};

/// Returns a value for each variable of a robot: the given value, or else the one that follows from the poses of the
/// links on tf. Variables on which no body depends may have any value.
/// @param robot  its joints must be known (RobotJoints::kinematics)
/// @param given  values, by name of the variable
/// @param tick   must have a snapshot
/// @throws Refusal unknown_frame, extrapolation if the pose of a link is not known at the time of the tick
PresentJoints presentJoints(const LoadedRobot& robot, const std::map<std::string, double>& given, const Tick& tick,
                            const TransformLookup& transforms);

/// The pose of a frame in the world at the time of a tick.
struct PresentPose {
  Pose world_from_frame;
  std::string doubt;  ///< why the frame may be elsewhere; empty: it is not
};

/// Returns the pose of a frame that places a robot.
/// @param what  names the frame in error sentences, for example "the frame 'odom' of multi_dof_joint_state"
/// @throws Refusal unknown_frame, extrapolation if the pose of the frame is not known
PresentPose presentPose(const LoadedRobot& robot, const std::string& frame, const std::string& what, const Tick& tick,
                        const TransformLookup& transforms);

/// Returns the pose of the root link of a robot: from a body that is rigidly connected to it, or else from tf.
/// @throws Refusal unknown_frame, extrapolation if the pose is not known
PresentPose presentRoot(const LoadedRobot& robot, const Tick& tick, const TransformLookup& transforms);

}  // namespace hgrid
