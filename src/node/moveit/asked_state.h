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
  /// Why nobody knows where the robot or something that moves with it would be; empty: it is known.
  std::string doubt;
};

/// Reads a RobotState of MoveIt: its joints, and where a virtual joint puts the robot.
/// @param group  name of a group of the SRDF; may be empty. It can decide which robot is meant.
/// @throws Refusal what robotWith(), presentJoints(), presentPose() and fromPose() throw
/// @throws Refusal out_of_range if lists have different lengths, dup_id for a joint that occurs twice
/// @throws Refusal conflict for a pose that its joint cannot have
/// @throws Refusal unsupported if the message attaches objects, or for a virtual joint of another link than the root
AskedState askedState(const moveit::RobotState& state, const std::string& group, const Tick& tick,
                      const TransformLookup& transforms);

}  // namespace hgrid
