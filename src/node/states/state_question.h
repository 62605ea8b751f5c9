// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

#include <geometry_msgs/Pose.h>

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "hgrid_proximity/queries/state_checker.h"
#include "node/states/checker_cache.h"
#include "node/tf/transform_lookup.h"
#include "node/tick/tick.h"

namespace hgrid {

/// What requests about states and edges have in common.
struct AskedStates {
  const std::string& robot;                           ///< name of the robot; empty: the one that has these joints
  const std::string& group;                           ///< name of a group of its SRDF; empty: all joints
  const std::vector<std::string>& joint_names;        ///< names of variables, with or without the name of the robot
  const std::vector<std::string>& ignore;             ///< globs over the names of bodies that do not count
  const std::vector<std::string>& other_joint_names;  ///< names of variables of other robots, as robot/variable
  const std::vector<double>& other_positions;         ///< [rad or m] their values
  std::optional<geometry_msgs::Pose> base;            ///< [m, world] pose of the root link; nullopt: where tf says
};

/// A request about states of a robot, prepared for StateChecker.
struct StateQuestion {
  std::shared_ptr<const StateChecker> checker;  ///< never null
  StateBatch batch;
  /// Why nobody knows where the robot, another robot of the request, or something that moves with one of them would be;
  /// empty: it is known.
  std::string doubt;
};

/// Prepares a request.
/// @param positions  rows of values of joint_names
/// @param tick       the tick that the request asks about
/// @param newest     the newest tick
/// @param cache      has the checkers of earlier requests
/// @throws Refusal what robotNamed() or robotWith(), presentJoints(), presentRoot(), fromPose() and StateChecker throw;
/// out_of_range if there are positions but no names of joints, or not one value for each of other_joint_names;
/// unknown_id, conflict or dup_id for an entry of other_joint_names; conflict if a robot of the request was loaded
/// again since the tick
StateQuestion stateQuestion(const AskedStates& asked, std::vector<double> positions, const Tick& tick,
                            const Tick& newest, const TransformLookup& transforms,
                            const std::shared_ptr<const NarrowPhase>& narrow_phase, CheckerCache& cache);

}  // namespace hgrid
