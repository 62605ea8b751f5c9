// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

#include "hgrid_proximity/maps/map_cells.h"

namespace hgrid {

/// [m] A StaticGrid::Look returns this limit to end the search.
constexpr double kNoFurther = -1.0;

/// Returns a box [m, map frame] that contains a box of the world, in spite of rounding. It is larger if the map is
/// rotated.
/// @param origin  [m, world] the point that `box` is relative to
Eigen::AlignedBox3d boxInMap(const Pose& map_from_world, const Aabb& box, const Eigen::Vector3d& origin);

/// Returns the distance [m] from a box [m, map frame] to the nearest voxel. It is infinite if no voxel is within
/// `up_to` [m], apart from rounding. For a box of boxInMap(), it is never larger than the exact distance.
double gapTo(const StaticGrid& grid, const Eigen::AlignedBox3d& box, double up_to);

}  // namespace hgrid
