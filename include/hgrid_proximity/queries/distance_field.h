// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "hgrid_proximity/geometry/pose.h"
#include "hgrid_proximity/queries/query_answer.h"
#include "hgrid_proximity/queries/query_scope.h"

namespace hgrid {

/// The points of a regular lattice. Point (i, j, k) is at resolution * (i, j, k) in the frame of the lattice.
struct Lattice {
  Pose world_from_lattice = Pose::Identity();      ///< [m] where the first point and the axes are in the world
  std::array<std::uint32_t, 3> count = {1, 1, 1};  ///< number of points along x, y and z
  double resolution = 0.1;                         ///< [m] distance of neighboring points, > 0

  /// Returns the number of all points.
  std::size_t size() const { return std::size_t{count[0]} * count[1] * count[2]; }
};

/// What distanceField() measures.
struct FieldRequest {
  double max_distance = 1.0;  ///< [m] a larger distance is returned as this value; > 0
  bool gradients = false;     ///< whether to return gradients as well
};

/// Signed distances at the points of a lattice. The x index changes fastest, then y, then z.
struct DistanceField {
  static constexpr double kUnknown = Proximity::kUnknown;  ///< NaN

  /// [m] For each point: distance of the nearest body or occupied cell of a map; negative inside of it. NaN: something
  /// unseen may be nearer, or there was no time to measure.
  std::vector<double> distance;
  /// For each point: gradient of the distance, a unit vector in the frame of the lattice. 0 where the distance is
  /// max_distance; NaN where the distance or the gradient is not known. Empty unless it was requested.
  std::vector<Eigen::Vector3d> gradient;
  std::size_t unknown = 0;        ///< number of points whose distance is NaN
  Unknown because = Unknown::no;  ///< why the distance of the first of them is not known
  std::string reason;             ///< the same as a sentence
};

/// Measures the distance to the nearest body at each point of a lattice. It measures the shapes of bodies, not their
/// boxes.
///
/// Outside of bodies the distance is exact. Inside, it is minus the distance from the surface, of the body in which the
/// point is deepest. It is 0 inside an open mesh. It is minus the padding inside a hull, if the narrow phase returns no depth. Cells count
/// one by one: the distance in a block of cells is that from the surface of one cell. A shape that cannot be measured
/// counts as its box. Stops at scope.deadline; the other points are then NaN (Unknown::budget).
///
/// The distance of neighboring points differs by at most the resolution. So the distance of one point limits the search
/// of the next one.
///
/// @param narrow_phase  measures points and bodies; it must have made the solids of the bodies
/// @param scope         which bodies count; `exact` and `limit` are not read
/// @throws Refusal out_of_range if a coordinate, the resolution or max_distance is not positive or beyond kQueryReach;
/// nonfinite if a coordinate is not finite; unknown_id as queries
DistanceField distanceField(const Snapshot& snapshot, const Lattice& lattice, const FieldRequest& request,
                            NarrowPhase& narrow_phase, const QueryScope& scope);

}  // namespace hgrid
