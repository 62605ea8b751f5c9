// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

#include <cstddef>
#include <vector>

#include "hgrid_proximity/geometry/voxel.h"

namespace hgrid {
namespace bench {

/// The occupied leaves, in Morton order, of a building as a scanner with an edge of 0.05 m would see it: rooms of
/// 6.4 x 6.4 x 3.2 m side by side and above each other, with floors and walls one cell thick and rough, a door in each
/// wall, and clutter: hollow and solid boxes, balls. Some cells are missing; eight equal ones are merged, as an octree
/// prunes them. The building grows from the map's origin along the Morton curve until it has so many leaves: two of
/// different sizes begin with the same leaves.
std::vector<Voxel> buildingOf(std::size_t leaves);

}  // namespace bench
}  // namespace hgrid
