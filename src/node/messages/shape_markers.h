// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

#include <visualization_msgs/Marker.h>

#include <vector>

#include "node/tick/tick.h"

namespace hgrid {

/// Returns markers that draw the collision shapes of all placed bodies, in namespace "shapes". The color shows what a
/// body is and how far its pose can be trusted:
///
///   blue    a link whose pose is FRESH or LATE        orange  STALE
///   beige   an obstacle whose pose is FRESH or LATE   purple  FROZEN
///                                                     red     LOST or INVALID
///
/// Shapes are drawn with their padding, except meshes and hulls. RViz reads a mesh from its file if there is one. A
/// mesh without a file is drawn by its triangles, or by its box if it has more than 20,000 triangles.
std::vector<visualization_msgs::Marker> shapeMarkers(const Tick& tick);

/// Returns markers for the boxes of the broad phase: wireframes in namespace "boxes", one color for each level of the
/// grid.
visualization_msgs::Marker boxMarker(const Tick& tick);

/// Returns texts with the names and states of the 20 worst bodies whose pose is STALE or worse, in namespace "states".
std::vector<visualization_msgs::Marker> stateMarkers(const Tick& tick);

}  // namespace hgrid
