// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

#include "maps/distance_blocks.h"
#include "queries/placed_map.h"
#include "queries/states/robot_shapes.h"

namespace hgrid {

/// Tells quickly which shapes of a robot are surely far from a map. It covers each shape with spheres and compares
/// their radii with the bounds of DistanceBlocks.
class MapClearance {
 public:
  /// @param map     its cells must outlive this object
  /// @param origin  [m, world] the point to which the boxes of the shapes are relative
  MapClearance(const PlacedMap& map, const Eigen::Vector3d& origin);

  /// Returns one bit for each of four states: whether the shape is surely farther than `reach` [m] from all voxels.
  /// @param lanes  bit i: whether the result matters for state i
  unsigned farther(const FourShapes& shape, const SphereCover& cover, const Four& reach, unsigned lanes) const;

 private:
  const DistanceBlocks* blocks_;  // null: nothing is known
  float turn_[3][3], shift_[3];   // from the world, relative to the origin, to finest edges of the map
  float per_edge_ = 0.0f;         // [1/m]
};

}  // namespace hgrid
