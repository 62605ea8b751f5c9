// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

#include <cstddef>
#include <vector>

#include "hgrid_proximity/geometry/voxel.h"

namespace hgrid {
namespace bench {

/// Returns the occupied leaves, in Morton order, of a building that was scanned into cells of 0.05 m.
///
/// The building has rooms of 6.4 x 6.4 x 3.2 m, side by side and above each other. Floors and walls are one cell thick
/// and rough, and each wall has a door. The rooms contain hollow and solid boxes and spheres. Some cells are missing.
/// Eight equal neighboring cells are merged into one leaf, as in a pruned octree.
///
/// The building grows from the map's origin along the Morton curve until it has `leaves` leaves. Therefore all
/// buildings begin with the same leaves.
std::vector<Voxel> buildingOf(std::size_t leaves);

}  // namespace bench
}  // namespace hgrid
