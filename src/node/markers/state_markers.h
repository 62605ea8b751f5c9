// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

#include <visualization_msgs/Marker.h>

#include <vector>

#include "node/markers/marker_scale.h"
#include "node/tick/tick.h"

namespace hgrid {

/// Returns texts that say which bodies have a pose that is STALE or worse, in namespace "states": one text for each
/// source, above these bodies, such as "left_arm: 7 LOST, 1 STALE". The 20 worst sources have a text. Texts
/// that would be close to each other are one text of several lines.
std::vector<visualization_msgs::Marker> stateMarkers(const Tick& tick, const MarkerScale& scale);

}  // namespace hgrid
