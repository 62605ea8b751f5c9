// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

#include <string>
#include <vector>

#include "node/robots/robot_entry.h"
#include "node/tf/frame_table.h"
#include "node/world/movers.h"

namespace hgrid {

/// Returns sentences that say why robots have links that never had a pose, and what to do: one about the world frame
/// if tf does not know it, and one about each robot whose frames are missing or not connected to it.
/// @param robots       the robots of the movers
/// @param frames       the frames of tf
/// @param world_frame  the world frame in use
/// @param configured   whether ~world_frame names it; otherwise it is the root of a robot
std::vector<std::string> whyUnplaced(const std::vector<Mover>& movers, const RobotEntries& robots,
                                     const FrameTable& frames, const std::string& world_frame, bool configured);

}  // namespace hgrid
