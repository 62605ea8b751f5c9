// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

#include <visualization_msgs/Marker.h>

#include <vector>

#include "node/params/params.h"
#include "node/tick/tick.h"

namespace hgrid {

/// Returns markers for the occupied cells of maps that are within ~map/shown_within of the box of a body, at most
/// ~limits/max_shown_cells cells. The namespace of the markers is "maps". There is one marker, a list of cubes, for each map and
/// each edge length of cells. RViz removes a marker that is no longer returned when its lifetime ends.
std::vector<visualization_msgs::Marker> mapMarkers(const Tick& tick, const Params& params);

}  // namespace hgrid
