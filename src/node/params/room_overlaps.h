// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

#include <string>
#include <vector>

#include "hgrid_proximity/broadphase/rooms.h"

namespace hgrid {

/// [m] A door is enlarged by this, because sums of decimal numbers are rounded.
constexpr double kDoorRounding = 1e-6;

/// Adds a door for each two rooms that overlap, because no wall separates them there: a margin that reaches through
/// their common space must not end at it. The door is the box around this space. Rooms that overlap by at most 1 mm
/// touch at a thin wall, so they get no door.
/// @param rooms   their normals have length 1
/// @param errors  if too many rooms are near each other, receives a sentence that says so
void addOverlaps(const std::vector<Room>& rooms, std::vector<Portal>& doors, std::vector<std::string>& errors);

}  // namespace hgrid
