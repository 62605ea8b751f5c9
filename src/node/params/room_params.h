// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

#include <vector>

#include "hgrid_proximity/broadphase/rooms.h"
#include "node/params/param_value.h"

namespace hgrid {

/// Reads ~rooms, a list of {name, pose, size} and {name, walls: [{normal, offset}]}. The normals of the result have
/// length 1.
std::vector<Room> readRooms(ParamValue value);

/// Reads ~doors, a list of {rooms: [two names], pose, size}. The opening of the result is a box around that of the
/// parameter, whose sides are parallel to the axes of the world frame.
/// @param rooms  the rooms that doors may name
std::vector<Portal> readDoors(ParamValue value, const std::vector<Room>& rooms);

}  // namespace hgrid
