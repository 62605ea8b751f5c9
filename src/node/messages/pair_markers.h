// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

#include <visualization_msgs/Marker.h>

#include <vector>

#include "node/tick/tick.h"

namespace hgrid {

/// The pairs of a tick. In namespace "pairs": a line between the nearest points of the two bodies, and a dot at each of
/// them. In namespace "pair_names": the names and the distance of the 8 nearest pairs [mm].
///
/// The nearest points are those of the shapes if the pair was measured; the color then goes from green at the margin to
/// red in contact. Otherwise they are those of the boxes, the line is gray, and the distance is at least the one given.
/// Pairs with a map that were not measured are not drawn. Of more than 2,000 pairs, those with the smallest gaps are drawn.
///
/// @param distances  of the tick's snapshot; null: nothing was measured
std::vector<visualization_msgs::Marker> pairMarkers(const Tick& tick, const PairDistances* distances);

}  // namespace hgrid
