// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

#include <array>
#include <memory>

#include "hgrid_proximity/maps/static_grid.h"
#include "hgrid_proximity/narrow/narrow_phase.h"

namespace hgrid {

/// What a map knows nothing of, in its frame: these cells, and all that lies beyond what it speaks of.
struct UnmappedSpace {
  StaticGrid cells;
  Eigen::AlignedBox3d extent;  ///< [m] what it speaks of
};

/// What is occupied of a map or a cloud, and its cells made ready to be measured. Immutable, shared by snapshots.
struct MapCells {
  std::shared_ptr<const StaticGrid> grid;                                   ///< in the frame of its body
  std::shared_ptr<const UnmappedSpace> unmapped = nullptr;                  ///< null: it knows no space to be free
  std::array<std::shared_ptr<const Solid>, Voxel::kLevels + 1> cubes = {};  ///< by level of the voxel

  /// The middle of a voxel [m] in the frame of its body.
  Eigen::Vector3d centerOf(const Voxel& voxel) const {
    return 0.5 * (minCorner(voxel, grid->finestEdge()) + maxCorner(voxel, grid->finestEdge()));
  }
};

std::shared_ptr<const MapCells> makeMapCells(std::shared_ptr<const StaticGrid> grid, const NarrowPhase& narrow_phase,
                                             std::shared_ptr<const UnmappedSpace> unmapped = nullptr);

}  // namespace hgrid
