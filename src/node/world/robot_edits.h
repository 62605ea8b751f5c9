// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

#include <string>

#include "node/params/params.h"
#include "node/robots/robot_change.h"
#include "node/robots/robot_entry.h"

namespace hgrid {

/// Checks whether a change of a robot is allowed, and whether it changes anything.
/// @param spec  for add: the robot
/// @returns false if the robot is already as requested, so that the change must be left out
/// @throws Refusal unknown_id; for add: dup_id, limit (~limits/max_robots, ~limits/max_description_bytes)
bool isNeeded(RobotOperation operation, const std::string& name, const RobotSpec* spec, const RobotEntries& robots,
              const Params& params);

/// Carries out a change, or does nothing if it is not needed. @throws Refusal as isNeeded()
void edit(const RobotChange& change, const Params& params, RobotEntries& robots);

/// Checks that a robot may be added, although ~world_frame is not set: it must have the same root.
/// @param world_frame  root of the first robot; empty: not known yet
/// @throws Refusal not_ready, conflict
void checkSharesRoot(const LoadedRobot& robot, const std::string& world_frame);

}  // namespace hgrid
