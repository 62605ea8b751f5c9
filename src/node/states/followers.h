// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

#include <map>
#include <string>

#include "node/tf/transform_lookup.h"
#include "node/tick/tick.h"

namespace hgrid {

/// Returns a sentence that names a body which would be elsewhere in a state, because it follows the robot over frames
/// that the model of the robot does not have: another robot on its tool, or an obstacle in a frame below a link.
/// Empty: there is none.
/// @param given       values of the state, by name of the variable; the other joints stay where they are
/// @param moves_root  whether the state moves the root link
/// @param placed      name of a robot whose root link is given and thus does not follow; empty: none
std::string followerOf(const LoadedRobot& robot, const std::map<std::string, double>& given, bool moves_root,
                       const std::string& placed, const Tick& tick, const TransformLookup& transforms);

}  // namespace hgrid
