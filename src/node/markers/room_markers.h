// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

#include <visualization_msgs/Marker.h>

#include <vector>

#include "node/tick/tick.h"

namespace hgrid {

/// Returns markers that draw ~rooms and ~doors: their edges and their names, in namespaces "rooms" and "doors". None if
/// there are no rooms. A room that is open is cut off 2 m beyond everything else.
///
/// The markers are the same for each tick, apart from their headers. It takes long to make them, so keep them.
std::vector<visualization_msgs::Marker> roomMarkers(const Tick& tick);

}  // namespace hgrid
