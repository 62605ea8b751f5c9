// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

#include "hgrid_proximity/queries/query_answer.h"
#include "hgrid_proximity/queries/query_scope.h"

namespace hgrid {

/// A plane of a body, at its pose in the world.
struct PlacedPlane {
  std::uint32_t body;
  std::uint32_t shape;   // index of the plane among the shapes of its body
  HalfSpace half_space;  // relative to the origin of the snapshot, padding included
  Pose world_from_plane;
  double padding;  // [m]

  /// Returns the signed distance [m] of a point from the surface. It is negative inside the half-space.
  /// @param point  [m] relative to the origin of the snapshot
  double signedDistanceOf(const Eigen::Vector3d& point) const { return signedDistance(half_space, point); }
  /// Returns a hit with the distance of the half-space from `point`. QueryHit::point is the point of the half-space
  /// nearest to `point`. If `point` is inside and the query is exact, it is the nearest point of the surface instead.
  /// @param point   [m] point of the query, relative to the origin of the snapshot
  /// @param origin  [m, world] origin of the snapshot
  QueryHit hitOf(const Eigen::Vector3d& point, const Eigen::Vector3d& origin, bool exact) const;
};

/// Calls `look` for each plane in the scope that has a pose.
template <class Look>
void forEachPlane(const Snapshot& snapshot, const QueryScope& scope, Look&& look) {
  const Structure& structure = snapshot.structure();
  for (std::size_t i = 0; i < structure.planes.size(); ++i) {
    const std::uint32_t body = structure.body_of_proxy[structure.planes[i]],
                        shape = structure.shapeOf(structure.planes[i]);
    const BodyPose& pose = snapshot.poses()[body];
    if (pose.state == Freshness::unplaced || !inScope(snapshot, scope, body)) continue;
    const BodyShape& plane = structure.bodies[body].shapes[shape];
    look(PlacedPlane{body, shape, snapshot.halfSpaces()[i], pose.world_from_body * plane.body_from_shape,
                     plane.padding});
  }
}

}  // namespace hgrid
