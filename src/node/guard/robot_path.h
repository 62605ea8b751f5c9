// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "hgrid_proximity/refusal.h"
#include "hgrid_proximity/world/snapshot.h"

namespace hgrid {

/// Where some joints of a robot will be: points with times. Between two points, each joint moves at constant speed.
/// Before the first point the joints stand at it, and after the last one they stay there.
struct RobotPath {
  std::string robot;                ///< name of the robot
  std::vector<std::string> joints;  ///< names of the variables, without the name of the robot
  std::vector<double> positions;    ///< [rad or m] one row of joints.size() values for each point
  std::vector<Time> times;          ///< [ROS time] when the robot is at each point, ascending
  /// Why the robot may move elsewhere, for example because its newest command could not be read; empty: it does not.
  std::string doubt;

  std::size_t points() const { return times.size(); }
  /// Returns the position of a joint at a time.
  double positionAt(std::size_t joint, Time time) const;
};

/// Checks that the lists of a path fit together, that its values are finite, that its times ascend, and that no joint
/// is named twice.
/// @throws Refusal out_of_range, nonfinite, conflict
void checkPath(const RobotPath& path);

/// Largest number of positions that are read or checked at one time.
inline constexpr std::size_t kMostPositions = 10000000;

/// Returns a path without some of its joints.
RobotPath withoutJoints(const RobotPath& path, const std::vector<std::string>& joints);

/// Paths of different robots, or different paths of one robot; never null.
using RobotPaths = std::vector<std::shared_ptr<const RobotPath>>;

/// Returns the path of a robot that follows several paths at the same time, for example one for each arm.
/// @param newest_first  at least one path; if several paths name a joint, the first of them gives its positions
std::shared_ptr<const RobotPath> mergePaths(const RobotPaths& newest_first);

}  // namespace hgrid
