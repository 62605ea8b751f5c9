// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

#include <array>
#include <memory>

#include "hgrid_proximity/maps/static_grid.h"
#include "hgrid_proximity/narrow/narrow_phase.h"

namespace hgrid {

class DistanceBlocks;

/// The space that a map does not know to be free or occupied: the unknown cells, and everything outside `extent`. All
/// values are in the frame of the map.
struct UnmappedSpace {
  StaticGrid cells;            ///< the unknown cells
  Eigen::AlignedBox3d extent;  ///< [m] the box that the map describes
};

/// The occupied cells of a map or a cloud, with the solids for measuring them. It is immutable, and snapshots share it.
struct MapCells {
  std::shared_ptr<const StaticGrid> grid;                     ///< occupied cells in the body's frame
  std::shared_ptr<const UnmappedSpace> unmapped = nullptr;    ///< unknown space; null: any space may be unknown
  std::shared_ptr<const DistanceBlocks> distances = nullptr;  ///< lower bounds of distances to the cells; may be null
  std::array<std::shared_ptr<const Solid>, Voxel::kLevels + 1> cubes = {};  ///< for each level: a cell as a solid

  /// Returns the center of a voxel [m] in the frame of its body.
  Eigen::Vector3d centerOf(const Voxel& voxel) const {
    return 0.5 * (minCorner(voxel, grid->finestEdge()) + maxCorner(voxel, grid->finestEdge()));
  }
};

/// Creates the cells of a map or a cloud. `narrow_phase` creates MapCells::cubes.
/// @param lasting  whether the cells stay for long; otherwise MapCells::distances is null, because its memory and the
///                 time to fill it do not pay
std::shared_ptr<const MapCells> makeMapCells(std::shared_ptr<const StaticGrid> grid, const NarrowPhase& narrow_phase,
                                             std::shared_ptr<const UnmappedSpace> unmapped = nullptr,
                                             bool lasting = true);

}  // namespace hgrid
