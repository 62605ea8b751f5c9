// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

#include "hgrid_proximity/maps/map_cells.h"

namespace hgrid {

/// [m] What a look at voxels (StaticGrid::Look) returns when it is over.
constexpr double kNoFurther = -1.0;

/// The box in a map's frame around a box of the world: larger where the map is turned.
/// @param origin  [m, world] that the box is relative to
Eigen::AlignedBox3d boxInMap(const Pose& map_from_world, const Aabb& box, const Eigen::Vector3d& origin);

/// [m] distance of the nearest voxel from a box in the map's frame; infinite if it is more than `up_to`, but for
/// rounding.
double gapTo(const StaticGrid& grid, const Eigen::AlignedBox3d& box, double up_to);

}  // namespace hgrid
