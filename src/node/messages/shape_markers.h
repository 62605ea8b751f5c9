// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

#include <visualization_msgs/Marker.h>

#include <vector>

#include "node/tick/tick.h"

namespace hgrid {

/// The collision shapes of all placed bodies as solids in their poses, in namespace "shapes". The color says what a body
/// is and how far its pose can be trusted:
///
///   blue    a link whose pose is FRESH or LATE        orange  STALE
///   beige   an obstacle whose pose is FRESH or LATE   purple  FROZEN
///                                                     red     LOST or INVALID
///
/// Shapes are drawn with their padding, except meshes and hulls. A mesh is drawn from its file if it came from one;
/// otherwise, if it has more than 20,000 triangles, its box is drawn instead.
std::vector<visualization_msgs::Marker> shapeMarkers(const Tick& tick);

/// The boxes that the broad phase compares, as wireframes in namespace "boxes", with one color per level of the grid.
visualization_msgs::Marker boxMarker(const Tick& tick);

/// Names and states of bodies whose pose is STALE or worse, as texts in namespace "states": the 20 worst.
std::vector<visualization_msgs::Marker> stateMarkers(const Tick& tick);

}  // namespace hgrid
