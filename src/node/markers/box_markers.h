// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

#include <visualization_msgs/Marker.h>

#include "node/markers/marker_scale.h"
#include "node/tick/tick.h"

namespace hgrid {

/// Returns a marker for the boxes of the broad phase: wireframes in namespace "boxes", one color for each level of the
/// grid.
visualization_msgs::Marker boxMarker(const Tick& tick, const MarkerScale& scale);

/// Returns a marker that draws a frame around each track, in namespace "tracks". It has the color of tracks also if the
/// track is near another body.
visualization_msgs::Marker trackMarker(const Tick& tick, const MarkerScale& scale);

}  // namespace hgrid
