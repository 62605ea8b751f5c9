// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

#include "maps/distance_blocks.h"
#include "queries/placed_map.h"
#include "queries/states/robot_shapes.h"

namespace hgrid {

/// Tells quickly which shapes of a robot are surely far from a map. Compares the spheres of a SphereCover with the
/// bounds of DistanceBlocks.
class MapClearance {
 public:
  /// @param map     its cells must outlive this object
  /// @param origin  [m, world] the point to which the boxes of the shapes are relative
  MapClearance(const PlacedMap& map, const Eigen::Vector3d& origin);

  /// Returns one bit for each of four states: whether the shape is surely farther than `reach` [m] from all voxels.
  /// @param lanes  bit i: whether the result matters for state i
  unsigned farther(const FourShapes& shape, const SphereCover& cover, const Four& reach, unsigned lanes) const;

 private:
  const DistanceBlocks* blocks_;  // null: no shape counts as far
  float turn_[3][3], shift_[3];   // transform a point, relative to the origin, to finest edges
  float per_edge_ = 0.0f;         // [1/m]
};

}  // namespace hgrid
