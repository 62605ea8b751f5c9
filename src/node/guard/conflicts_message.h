// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

#include <hgrid_proximity/Conflicts.h>

#include <vector>

#include "node/guard/path_check.h"
#include "node/messages/to_messages.h"

namespace hgrid {

/// Returns the message of ~conflicts.
/// @param answers  one for each path
/// @param since    for each conflict in the answers: when it was found for the first time
msg::Conflicts conflictsMessage(const Tick& tick, const RobotPaths& paths, const std::vector<PathAnswer>& answers,
                                const std::vector<Time>& since);

}  // namespace hgrid
