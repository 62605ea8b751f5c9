// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

#include <string>
#include <vector>

#include "hgrid_proximity/queries/state_checker.h"
#include "node/moveit/validity_types.h"
#include "node/tf/transform_lookup.h"
#include "node/tick/tick.h"

namespace hgrid {

/// The state of a robot that a RobotState of MoveIt describes.
struct AskedState {
  const LoadedRobot& robot;
  /// One state with a value for each variable. The variables that the message does not name are where they are at
  /// present.
  StateBatch batch;
};

/// Reads a RobotState of MoveIt: its joints, and where a virtual joint puts the robot.
/// @param group  name of a group of the SRDF; may be empty. It can decide which robot is meant.
/// @throws Refusal what robotWith() and presentJoints() throw; out_of_range if lists have different lengths;
/// unsupported if the message attaches objects; what fromPose() and TransformLookup::atOrNewest() throw
AskedState askedState(const moveit::RobotState<moveit::Release::noetic>& state, const std::string& group,
                      const Tick& tick, const TransformLookup& transforms);

}  // namespace hgrid
