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

// Questions about a snapshot. All coordinates are in the world frame [m]. Any number of threads may ask the same
// snapshot at the same time. The padding of bodies counts, their margins do not.
//
// A query that finds nothing answers CLEAR only if nothing that it asks about can be there unseen: each source in its
// scope is complete or cannot reach the region of the query, and no body can have moved into it since its last pose.

/// [m] Queries may reach this far from the world's origin, per axis.
inline constexpr double kQueryReach = 1e10;

/// The box that a query asks about.
using QueryBox = OrientedBox;

/// A shape of any kind in any pose.
struct QueryShape {
  Shape shape;
  Pose world_from_shape = Pose::Identity();
  double padding = 0.0;  ///< [m] by which the shape is grown on all sides, >= 0
};

/// Finds the bodies whose boxes (exact: shapes) touch the sphere.
/// @throws Refusal nonfinite, bad_geometry (negative radius), out_of_range (beyond kQueryReach), unknown_id
/// (QueryScope::respect_allowed is not the index of a body)
QueryAnswer query(const Snapshot& snapshot, const Sphere& sphere, const QueryScope& scope);

/// Finds the bodies whose boxes (exact: shapes) the segment meets, in the order in which it meets them.
/// @throws Refusal as for a sphere
QueryAnswer query(const Snapshot& snapshot, const Segment& segment, const QueryScope& scope);

/// Finds the bodies whose boxes (exact: shapes) touch the box.
/// @param narrow_phase  measures the query's box against the boxes of bodies, also if the query is not exact
/// @throws Refusal as for a sphere
QueryAnswer query(const Snapshot& snapshot, const QueryBox& box, const NarrowPhase& narrow_phase,
                  const QueryScope& scope);

/// Finds the bodies whose boxes (exact: shapes) touch the shape. Its center is the origin of its frame.
/// @param narrow_phase  as for a box; makes the shape ready to be measured
/// @throws Refusal as for a sphere, and as NarrowPhase::solidOf(); unsupported if that gives no solid
QueryAnswer query(const Snapshot& snapshot, const QueryShape& shape, NarrowPhase& narrow_phase,
                  const QueryScope& scope);

/// Finds the bodies nearest to a point: as many as scope.limit says (0: one). QueryAnswer::total counts only these.
/// @param max_distance  [m] farther bodies are no hits; 0: no limit
/// @throws Refusal as for a sphere
QueryAnswer nearest(const Snapshot& snapshot, const Eigen::Vector3d& point, double max_distance,
                    const QueryScope& scope);

/// Finds the bodies nearest to the body with index `from`, which itself is no hit.
/// @throws Refusal as above; not_ready if that body has no pose or no shapes
QueryAnswer nearest(const Snapshot& snapshot, std::uint32_t from, double max_distance, const QueryScope& scope);

}  // namespace hgrid
