// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

#include <visualization_msgs/Marker.h>

#include <vector>

#include "node/markers/marker_scale.h"
#include "node/markers/near_pairs.h"
#include "node/tick/tick.h"

namespace hgrid {

/// Returns two texts above the world, in namespace "verdict":
///
/// 0. COMPLETE and the number of near pairs, or NOT COMPLETE and the first reason, in red;
/// 1. below it: the list of the nearest pairs, see listText().
///
/// The texts never cover each other, from wherever one looks: both have the same place, height and number of lines, and
/// no line has words in both.
std::vector<visualization_msgs::Marker> verdictMarkers(const Tick& tick, const NearPairs& near,
                                                       const MarkerScale& scale);

}  // namespace hgrid
