// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#include "queries/placed_map.h"

namespace hgrid {

QueryHit PlacedMap::hitOf(const Voxel& voxel, const Eigen::Vector3d& center, double distance, bool exact) const {
  QueryHit hit;
  hit.body = body;
  hit.cell_edge = edgeOf(voxel);
  hit.center_distance = hit.distance = distance;
  const Eigen::Vector3d point = nearestPoint(cubeOf(voxel), center);
  hit.point = world_from_map * point;
  if (!exact) return hit;
  hit.status = distance > 0.0 ? Measure::apart : Measure::contact;
  if (distance > 0.0) hit.normal = world_from_map.linear() * (center - point).normalized();
  return hit;
}

bool asksMaps(const Snapshot& snapshot, const QueryScope& scope) {
  bool has_maps = false;
  for (const std::uint32_t map : snapshot.structure().maps) {
    if (snapshot.structure().bodies[map].kind == BodyKind::cloud) continue;
    if (inScope(snapshot, scope, map)) return true;
    has_maps = true;
  }
  return !has_maps && scope.include.empty();
}

}  // namespace hgrid
