// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

#include <visualization_msgs/Marker.h>

#include <vector>

#include "node/tick/tick.h"

namespace hgrid {

/// Returns markers for the pairs of a tick. In namespace "pairs": a line between the nearest points of the two bodies,
/// and a dot at each of the two points. In namespace "pair_names": the names and the distance [mm] of the 8 nearest
/// pairs; measured pairs come first.
///
/// - If the pair was measured, the points are on the shapes. The color is green at the margin and red in contact.
/// - If the pair was not measured, the points are on the boxes and the line is gray. The text says "at least" and the
///   gap. If a body of the pair is a map, nothing is drawn.
///
/// Of more than 2,000 pairs, those with the smallest gaps are drawn.
/// @param distances  of the tick's snapshot; null: nothing was measured
std::vector<visualization_msgs::Marker> pairMarkers(const Tick& tick, const PairDistances* distances);

}  // namespace hgrid
