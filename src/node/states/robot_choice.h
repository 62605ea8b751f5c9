// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

#include <string>
#include <vector>

#include "node/tick/tick.h"

namespace hgrid {

/// Returns the name of a joint without the name of the robot before it: "arm/elbow" of the robot "arm" is "elbow".
std::string jointOf(const std::string& name, const std::string& robot);

/// Returns the robot that a request about joints means: the only one that has all of them, and the group. If the
/// request names neither, it is the first robot of ~robots; without ~robots, the only robot in the world.
/// @param joints  names of variables, joints or virtual joints, with or without the name of the robot before them
/// @param group   name of a group of its SRDF; may be empty
/// @throws Refusal not_ready if the robot is not in the world, or if its joints cannot be used
/// @throws Refusal unknown_id if no robot has all the joints, conflict if several robots have them
/// @throws Refusal limit if the request names more joints than any robot can have
const LoadedRobot& robotWith(const std::vector<std::string>& joints, const std::string& group, const Tick& tick);

/// Returns the robot of this name. @throws Refusal unknown_id; not_ready as robotWith()
const LoadedRobot& robotNamed(const std::string& name, const Tick& tick);

}  // namespace hgrid
