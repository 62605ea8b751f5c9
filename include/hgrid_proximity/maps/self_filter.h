// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "hgrid_proximity/geometry/voxel.h"
#include "hgrid_proximity/narrow/narrow_phase.h"

namespace hgrid {

/// A shape of the robot itself that a sensor may have seen.
struct SelfShape {
  Shape shape;                         ///< the shape in its own frame
  std::shared_ptr<const Solid> solid;  ///< the same shape, prepared by the narrow phase that withoutSelf() uses
  Pose world_from_shape;               ///< pose of the shape when the sensor measured
  double padding = 0.0;                ///< [m] cells at most this far from the shape count as part of it
};

/// The cells of a map that do not belong to the robot itself.
struct OthersCells {
  std::vector<Voxel> voxels;    ///< the cells that are left, disjoint and in Morton order
  std::uint64_t left_out = 0;   ///< cells of level 0 that were removed: they are inside a padded shape
  std::uint64_t undecided = 0;  ///< cells that were kept without a check, because there were too many to check
};

/// Removes the cells of the robot itself from the cells of a map.
///
/// A cell of level 0 is removed if its center is inside a padded shape. A larger cell that is only partly inside is
/// split, and its remaining smaller cells are kept. Any thread may call this.
/// @param edge    [m] edge of a voxel of level 0
/// @param voxels  the cells of the map, disjoint and in Morton order
/// @param world_from_map  pose of the map at the time of the poses of `shapes`
/// @param narrow_phase    created the solids of `shapes`
OthersCells withoutSelf(const std::vector<Voxel>& voxels, double edge, const Pose& world_from_map,
                        const std::vector<SelfShape>& shapes, const NarrowPhase& narrow_phase);

}  // namespace hgrid
