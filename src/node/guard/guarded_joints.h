// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

#include <string>
#include <vector>

#include "node/guard/joint_states.h"
#include "node/guard/robot_path.h"
#include "node/tf/transform_lookup.h"
#include "node/tick/tick.h"

namespace hgrid {

/// Where the joints of a robot with a path are at the time of a tick, with full turns.
///
/// tf does not tell full turns apart: an angle of 4 rad looks like one of -2.28 rad. For a joint whose limits allow
/// several turns, the joint states of the robot tell which one it is.
struct GuardedJoints {
  std::vector<double> values;  ///< [rad or m] one for each variable
  /// For each variable: whether the joint may be at other full turns than `values` says, where its path leads to other
  /// motions. Joints that turn freely count as known, because they take the shorter way to their paths.
  std::vector<bool> turn_hidden;
  std::string joint_states;  ///< name of the topic that should tell the turns
  std::string doubt;         ///< why the joints may stand elsewhere; empty: they do not
};

/// @throws Refusal as presentJoints()
GuardedJoints guardedJoints(const LoadedRobot& robot, const Tick& tick, const TransformLookup& transforms,
                            const JointStates& joint_states);

/// Returns whether tf cannot tell at which turn a joint of the robot is, wherever it is.
bool mayHideTurns(const LoadedRobot& robot);

/// Returns a sentence that names a joint of a path whose turn is not known; empty: there is none.
std::string hiddenTurnOf(const RobotPath& path, const LoadedRobot& robot, const GuardedJoints& joints);

/// Returns a sentence that names what moves although no path moves it: a joint of the robot, or its root link. Bodies
/// of the robot must depend on it. Empty: all of that has been at rest for 0.9 s.
std::string unplannedMotionOf(const RobotPath& path, const LoadedRobot& robot, const Tick& tick,
                              const TransformLookup& transforms);

}  // namespace hgrid
