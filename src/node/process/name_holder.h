// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

#include <optional>

#include "node/process/command_line.h"

namespace hgrid {

/// Exit code of the process if it does not start because a running node has its name.
constexpr int kNameHeldExitCode = 4;

/// Decides whether this node may register its name at the ROS master. Without this decision, the master would end a
/// running node of the same name.
///
/// Asks the master which process has the name, and then asks this process. If the process does not answer within 1 s,
/// or if it is another node that now has the same port, this function logs that, and this node may start. So a node
/// that crashed or hangs does not prevent the start of the next one. (Looking up the host name of the process may take
/// longer.) If the node with the name ends within 2 s, as after `rosnode kill`, this node may start as well.
///
/// Two nodes that start at the same moment do not see each other. The master then ends one of them, or both.
///
/// Call this after ros::init() and before the first ros::NodeHandle. Waits for the master if there is none, like
/// ros::NodeHandle. Does not ask anyone if `conflict` is NameConflict::replace.
///
/// @returns nullopt if this node may start; otherwise the exit code with which the process must end
std::optional<int> exitCodeOfNameConflict(NameConflict conflict);

}  // namespace hgrid
