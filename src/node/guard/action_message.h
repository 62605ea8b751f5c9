// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "node/guard/action_goals.h"

namespace hgrid {

/// Returns the id of the goal in a message that commands a path; nullopt: it is no goal of an action.
/// @param bytes  the serialized message
/// @param md5    of the type of the message
/// @throws Refusal truncated
std::optional<GoalId> readGoalId(const std::string& bytes, const std::string& md5);

/// Reads a message of the topic cancel of an action: actionlib_msgs/GoalID.
/// @throws Refusal truncated; unsupported for another type
GoalId readCancel(const std::string& bytes, const std::string& md5);

/// Reads a message of the topic status of an action: actionlib_msgs/GoalStatusArray.
/// @throws Refusal truncated; unsupported for another type
std::vector<GoalStatus> readStatus(const std::string& bytes, const std::string& md5);

/// Reads the status in a message of the topic result of an action: control_msgs/FollowJointTrajectoryActionResult.
/// @throws Refusal truncated; unsupported for another type
GoalStatus readResult(const std::string& bytes, const std::string& md5);

}  // namespace hgrid
