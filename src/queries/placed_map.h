// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

#include "hgrid_proximity/world/snapshot.h"

namespace hgrid {

/// A map as it lies in the world.
struct PlacedMap {
  std::uint32_t body;
  const MapCells& cells;
  const Pose& world_from_map;
  Pose map_from_world;
  double reach;  // [m] how far it may be from where its pose puts it

  double edgeOf(const Voxel& voxel) const { return hgrid::edgeOf(voxel, cells.grid->finestEdge()); }
  Eigen::AlignedBox3d cubeOf(const Voxel& voxel) const {
    return {minCorner(voxel, cells.grid->finestEdge()), maxCorner(voxel, cells.grid->finestEdge())};
  }
  /// The point of a voxel, in the map's frame, that is nearest to another.
  Eigen::Vector3d nearestOf(const Voxel& voxel, const Eigen::Vector3d& point) const {
    const Eigen::AlignedBox3d cube = cubeOf(voxel);
    return point.cwiseMax(cube.min()).cwiseMin(cube.max());
  }
  Pose worldFromCube(const Voxel& voxel) const { return world_from_map * Eigen::Translation3d(cells.centerOf(voxel)); }
};

/// Those in scope that have a pose and cells.
template <class Look>
void Snapshot::forEachMap(const QueryScope& scope, Look&& look) const {
  for (std::size_t i = 0; i < cells_.size(); ++i) {
    const std::uint32_t body = structure_->maps[i];
    const BodyPose& pose = poses_[body];
    if (!cells_[i] || pose.state == Freshness::unplaced || !inScope(scope, body)) continue;
    look(PlacedMap{body, *cells_[i], pose.world_from_body, pose.world_from_body.inverse(), pose.reach});
  }
}

}  // namespace hgrid
