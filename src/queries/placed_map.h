// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

#include "hgrid_proximity/maps/map_cells.h"
#include "hgrid_proximity/queries/query_answer.h"
#include "hgrid_proximity/queries/query_scope.h"

namespace hgrid {

/// A map or cloud with its occupied cells, at its pose in the world.
struct PlacedMap {
  std::uint32_t body;
  const MapCells& cells;
  const Pose& world_from_map;
  Pose map_from_world;
  double reach;  // [m] how far the map may have moved since its pose

  double edgeOf(const Voxel& voxel) const { return hgrid::edgeOf(voxel, cells.grid->finestEdge()); }
  /// Returns the voxel as a box in the frame of the map.
  Eigen::AlignedBox3d cubeOf(const Voxel& voxel) const {
    return {minCorner(voxel, cells.grid->finestEdge()), maxCorner(voxel, cells.grid->finestEdge())};
  }
  const Solid& solidOf(const Voxel& voxel) const { return *cells.cubes[voxel.level]; }
  Pose worldFromCube(const Voxel& voxel) const { return world_from_map * Eigen::Translation3d(cells.centerOf(voxel)); }
  /// Returns a hit for a voxel. QueryHit::point is the point of the voxel that is nearest to `center`.
  /// @param center    [m] center of the query, in the frame of the map
  /// @param distance  [m] distance of the voxel from `center`
  QueryHit hitOf(const Voxel& voxel, const Eigen::Vector3d& center, double distance, bool exact) const;
};

/// Calls `look` for each map and cloud in the scope that has a pose and cells.
template <class Look>
void forEachMap(const Snapshot& snapshot, const QueryScope& scope, Look&& look) {
  for (std::size_t i = 0; i < snapshot.cells().size(); ++i) {
    const std::uint32_t body = snapshot.structure().maps[i];
    const BodyPose& pose = snapshot.poses()[body];
    const std::shared_ptr<const MapCells>& cells = snapshot.cells()[i];
    if (!cells || pose.state == Freshness::unplaced || !inScope(snapshot, scope, body)) continue;
    look(PlacedMap{body, *cells, pose.world_from_body, pose.world_from_body.inverse(), pose.reach});
  }
}

/// Returns whether a map must know the region to be free. That is not so if the scope of the query leaves out all maps.
bool asksMaps(const Snapshot& snapshot, const QueryScope& scope);

}  // namespace hgrid
