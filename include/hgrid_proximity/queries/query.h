// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

#include <cstdint>

#include "hgrid_proximity/geometry/oriented_box.h"
#include "hgrid_proximity/geometry/pose.h"
#include "hgrid_proximity/geometry/segment.h"
#include "hgrid_proximity/geometry/shape.h"
#include "hgrid_proximity/geometry/sphere.h"
#include "hgrid_proximity/queries/query_answer.h"
#include "hgrid_proximity/queries/query_scope.h"
#include "hgrid_proximity/world/snapshot.h"

namespace hgrid {

// Queries about a snapshot. All coordinates are in the world frame [m]. Any number of threads may query the same
// snapshot at the same time. Queries include the padding of bodies, but not their margins.
//
// The region of a query is the part of space in which a body would be a hit. A query that finds nothing answers CLEAR
// only if no body in its scope can be in the region unseen. For this, each source in the scope must be complete or
// unable to reach the region, and no body can have moved into the region since its last pose.

/// [m] Largest absolute value of a coordinate or length in a query.
inline constexpr double kQueryReach = 1e10;

/// The box of a box query.
using QueryBox = OrientedBox;

/// The shape of a shape query: any kind of shape at any pose.
struct QueryShape {
  Shape shape;                               ///< the shape in its own frame
  Pose world_from_shape = Pose::Identity();  ///< pose of the shape in the world
  double padding = 0.0;                      ///< [m] the shape is grown by this length on all sides, >= 0
};

/// Finds the bodies whose boxes touch the sphere. An exact query compares their shapes instead of their boxes.
/// @throws Refusal nonfinite if the center is not finite
/// @throws Refusal bad_geometry if the radius is negative or not finite
/// @throws Refusal out_of_range if a coordinate or the radius is beyond kQueryReach
/// @throws Refusal unknown_id if QueryScope::respect_allowed is not the index of a body
QueryAnswer query(const Snapshot& snapshot, const Sphere& sphere, const QueryScope& scope);

/// Finds the bodies whose boxes (exact query: shapes) the segment touches, in the order along the segment.
/// @throws Refusal in the same cases as the sphere query
QueryAnswer query(const Snapshot& snapshot, const Segment& segment, const QueryScope& scope);

/// Finds the bodies whose boxes (exact query: shapes) touch the box.
/// @param narrow_phase  measures the box of the query against the boxes of bodies, even if the query is not exact
/// @throws Refusal in the same cases as the sphere query
QueryAnswer query(const Snapshot& snapshot, const QueryBox& box, const NarrowPhase& narrow_phase,
                  const QueryScope& scope);

/// Finds the bodies whose boxes (exact query: shapes) touch the shape. The center of the query is the origin of the
/// shape's frame.
/// @param narrow_phase  as in a box query; it also converts the shape into a solid
/// @throws Refusal in the same cases as the sphere query and NarrowPhase::solidOf()
QueryAnswer query(const Snapshot& snapshot, const QueryShape& shape, NarrowPhase& narrow_phase,
                  const QueryScope& scope);

/// Finds the bodies nearest to a point: scope.limit bodies, or one if scope.limit is 0. QueryAnswer::total counts only
/// these bodies.
/// @param max_distance  [m] bodies farther away are no hits; 0: no limit
/// @throws Refusal in the same cases as the sphere query
QueryAnswer nearest(const Snapshot& snapshot, const Eigen::Vector3d& point, double max_distance,
                    const QueryScope& scope);

/// Finds the bodies nearest to the body with index `from`. The body `from` itself is no hit.
/// @throws Refusal in the same cases as the query for a point
/// @throws Refusal not_ready if the body `from` has no pose or no shapes
/// @throws Refusal unsupported if the body `from` is a map or a cloud
QueryAnswer nearest(const Snapshot& snapshot, std::uint32_t from, double max_distance, const QueryScope& scope);

}  // namespace hgrid
