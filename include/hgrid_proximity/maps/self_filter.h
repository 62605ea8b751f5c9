// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "hgrid_proximity/geometry/voxel.h"
#include "hgrid_proximity/narrow/narrow_phase.h"

namespace hgrid {

/// A shape that a sensor may have seen of the robot itself.
struct SelfShape {
  Shape shape;
  std::shared_ptr<const Solid> solid;
  Pose world_from_shape;
  double padding = 0.0;  ///< [m] what is as near to the shape is taken for it, too
};

/// What is left of the cells of a map.
struct OthersCells {
  std::vector<Voxel> voxels;    ///< disjoint, in Morton order
  std::uint64_t left_out = 0;   ///< finest cells that lay in a padded shape
  std::uint64_t undecided = 0;  ///< cells kept without a look, since there were too many to look at
};

/// Leaves out of a map's cells what is the robot's own: the finest cells whose middles lie in a padded shape. Of larger
/// cells that reach out of it the rest stays, in smaller ones. Any thread.
/// @param edge    [m] of a voxel of level 0
/// @param voxels  disjoint, in Morton order
OthersCells withoutSelf(const std::vector<Voxel>& voxels, double edge, const Pose& world_from_map,
                        const std::vector<SelfShape>& shapes, const NarrowPhase& narrow_phase);

}  // namespace hgrid
