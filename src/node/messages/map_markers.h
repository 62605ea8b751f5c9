// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

#include <visualization_msgs/Marker.h>

#include <vector>

#include "node/params/params.h"
#include "node/tick/tick.h"

namespace hgrid {

/// The occupied cells of maps that are within ~map/shown_within of a body's box, at most ~map/max_shown of them: in
/// namespace "maps" one list of cubes for each map and edge. They vanish by themselves.
std::vector<visualization_msgs::Marker> mapMarkers(const Tick& tick, const Params& params);

}  // namespace hgrid
