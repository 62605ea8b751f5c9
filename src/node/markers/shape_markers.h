// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

#include <visualization_msgs/Marker.h>

#include <vector>

#include "node/markers/near_pairs.h"
#include "node/tick/tick.h"

namespace hgrid {

/// Returns markers that draw the collision shapes of all placed bodies, in namespace "shapes". The color shows what a
/// body is, how near it is to others and whether its pose can be trusted, see marker_colors.h. A plane
/// always has the color of its kind.
///
/// Shapes are drawn with their padding, except meshes and hulls. RViz reads a mesh from its file if there is one. A
/// mesh without a file is drawn by its triangles, or by its box if it has more than 20,000 triangles.
std::vector<visualization_msgs::Marker> shapeMarkers(const Tick& tick, const NearPairs& near);

}  // namespace hgrid
