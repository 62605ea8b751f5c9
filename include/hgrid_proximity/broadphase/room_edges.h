// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

#include <vector>

#include "hgrid_proximity/broadphase/rooms.h"

namespace hgrid {

/// An edge of a room: a line segment [m, frame of the room].
struct RoomEdge {
  Eigen::Vector3d from;  ///< one end
  Eigen::Vector3d to;    ///< the other end
};

/// Returns the edges of the part of a room that is inside of a box, for drawings and checks. Empty if the room has no
/// space there. An edge at which more than two walls meet is listed more than once. Takes time that grows with the
/// third power of the number of walls.
/// @param room    its normals must not be 0
/// @param within  [m] not empty; cuts off rooms that are open or larger. Its coordinates are at most 1e7
std::vector<RoomEdge> edgesOf(const Room& room, const Eigen::AlignedBox3d& within);

/// Returns the box around edgesOf(); empty if there are none. The arguments are those of edgesOf().
Eigen::AlignedBox3d boundsOf(const Room& room, const Eigen::AlignedBox3d& within);

}  // namespace hgrid
