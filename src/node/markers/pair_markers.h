// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

#include <visualization_msgs/Marker.h>

#include <vector>

#include "node/markers/marker_scale.h"
#include "node/markers/near_pairs.h"
#include "node/tick/tick.h"

namespace hgrid {

inline constexpr std::size_t kMostListed = 6;  ///< number of nearest pairs that have a number and a line of text

/// Returns markers for the near pairs of a tick. In namespace "pairs": a line between the nearest points of the two
/// bodies, and a dot at each of the two points. In namespace "pair_numbers": the numbers of the nearest pairs, as
/// listText() lists them. Numbers of pairs at one place share one text.
///
/// If the pair was measured, the points are on the shapes, and the line is white. If not, the points are on the boxes,
/// and the line is gray. It is also gray if the pose of a body is STALE or worse. Lines without a number are faint.
std::vector<visualization_msgs::Marker> pairMarkers(const Tick& tick, const NearPairs& near, const MarkerScale& scale);

/// Returns the names and the distances [mm] of the nearest pairs: a line with a number for each, without a line break
/// at the end. The text says "at least" if the pair was not measured, and the worse state of the poses if it is STALE
/// or worse.
std::string listText(const Tick& tick, const NearPairs& near);

}  // namespace hgrid
