// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

#include <chrono>
#include <limits>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "hgrid_proximity/narrow/narrow_phase.h"
#include "hgrid_proximity/queries/query_answer.h"
#include "node/guard/joint_states.h"
#include "node/guard/robot_path.h"
#include "node/tf/transform_lookup.h"
#include "node/tick/tick.h"

namespace hgrid {

/// Two bodies that will touch each other if a robot follows its path.
struct PathConflict {
  std::string first, second;  ///< names of the bodies; `first` is of the robot
  Contact contact;            ///< where they meet
  Time at{0};                 ///< [ROS time] when they meet
};

/// Whether the path of a robot is free.
struct PathAnswer {
  /// clear: the robot is proved to touch nothing for the next PathLimits::ahead seconds, if it follows its path, if the
  /// other robots follow theirs, and if everything else stays where it is.
  Verdict verdict = Verdict::unknown;
  std::string reason;                    ///< why the verdict is unknown; otherwise empty
  double free_for = 0.0;                 ///< [s] for this long from now on, the path is proved to be free
  std::optional<PathConflict> conflict;  ///< the first conflict that was found; nullopt: none
};

/// What limits a check of paths.
struct PathLimits {
  double ahead = 10.0;     ///< [s] how far ahead the paths are checked
  double deviation = 0.1;  ///< [rad or m] how far a joint may be from its path; otherwise the robot is not on its path
  std::chrono::steady_clock::time_point deadline;  ///< what was not checked by then is unknown
};

/// Checks the paths of robots against the world of a tick, and against each other at the same times.
///
/// All robots of the paths move together (joinRobots()). Each robot in turn is the one whose contacts are looked for
/// (StateCheckerOptions::robots). The times of all points divide the paths into edges, on which every joint moves at
/// constant speed. StateChecker::checkEdges() proves that an edge is free, or it finds the first contact. If nobody
/// knows where a robot will be, no path is clear.
/// @param paths  paths of different robots
/// @returns one answer for each path
std::vector<PathAnswer> checkPaths(const RobotPaths& paths, const Tick& tick, const PathLimits& limits,
                                   const TransformLookup& transforms, const JointStates& joint_states,
                                   const std::shared_ptr<const NarrowPhase>& narrow_phase);

}  // namespace hgrid
