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
  std::array<std::uint32_t, 3> count = {1, 1, 1};  ///< number of points along x, y and z; each >= 1
  double resolution = 0.1;                         ///< [m] distance of neighboring points, > 0

  /// Returns the number of all points.
  std::size_t pointCount() const { return std::size_t{count[0]} * count[1] * count[2]; }
};

/// What distanceField() measures.
struct FieldRequest {
  double max_distance = 1.0;  ///< [m] larger distances become max_distance, larger depths -max_distance; > 0
  bool gradients = false;     ///< whether to return gradients as well
};

/// Signed distances at the points of a lattice. The x index changes fastest, then y, then z.
struct DistanceField {
  static constexpr double kUnknown = Proximity::kUnknown;  ///< NaN

  /// [m] For each point: signed distance of the nearest body, negative inside a body. NaN: a body that the snapshot
  /// does not know may be nearer, a known body may have moved nearer, or the deadline passed before the point was
  /// measured.
  std::vector<double> distance;
  /// For each point: gradient of the distance, a unit vector in the frame of the lattice. 0 where the distance is
  /// max_distance or -max_distance. NaN where the distance or the gradient is not known. Empty unless
  /// FieldRequest::gradients is true.
  std::vector<Eigen::Vector3d> gradient;
  std::size_t unknown = 0;        ///< number of points whose distance is NaN
  Unknown because = Unknown::no;  ///< why the distance of the first unknown point is not known
  std::string reason;             ///< the value of `because` as a sentence; empty if no point is unknown
};

/// Measures the signed distance of the nearest body at each point of a lattice. Measures the shapes of bodies, not
/// their boxes.
///
/// Outside of all bodies, the value is the exact distance. In these cases it may be smaller, never larger:
/// - A shape without a solid is measured as its box.
/// - If a point may be inside an open mesh, or if the narrow phase fails, the value is 0 or minus the padding.
///
/// Inside a body, the value is minus the depth, which is the distance from the surface of the shape. If several shapes
/// contain the point, the largest depth counts. In these cases the depth may be too small:
/// - Inside a convex hull, it is the padding if the narrow phase returns no depth.
/// - Inside a mesh of several parts that overlap, it is the distance from the nearest triangle, which may be inside
///   another part.
/// - Inside a map, it is the depth in the one cell that contains the point, even if adjacent cells are occupied.
///
/// Stops at scope.deadline; the points that are not measured yet become NaN (Unknown::budget).
///
/// @param narrow_phase  measures distances of points and bodies; it must have made the solids of the bodies
/// @param scope         which bodies count; `exact` and `limit` are ignored
/// @throws Refusal nonfinite if a coordinate of the lattice is not finite
/// @throws Refusal out_of_range if a coordinate of the lattice is beyond -kQueryReach .. kQueryReach
/// @throws Refusal limit if there are more than 2^30 points
/// @throws Refusal out_of_range if the resolution or max_distance is not positive or is greater than kQueryReach
/// @throws Refusal unknown_id if scope.respect_allowed is not the index of a body
DistanceField distanceField(const Snapshot& snapshot, const Lattice& lattice, const FieldRequest& request,
                            NarrowPhase& narrow_phase, const QueryScope& scope);

}  // namespace hgrid
