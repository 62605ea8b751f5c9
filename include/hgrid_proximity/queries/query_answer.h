// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <string>
#include <vector>

#include "hgrid_proximity/narrow/narrow_phase.h"

namespace hgrid {

/// The result of a query. hit: the query hit a body. clear: it surely hits no body in its scope. unknown: neither is
/// known.
enum class Verdict : std::uint8_t { unknown = 0, clear = 1, hit = 2 };

/// Why a verdict is unknown. Do not change the numbers: messages contain them.
enum class Unknown : std::uint8_t {
  no = 0,          ///< the verdict is not unknown
  refused = 1,     ///< the query is not valid; the library throws a Refusal instead of returning this
  incomplete = 2,  ///< an unknown body of an incomplete source may be a hit, or a known body can be anywhere
  stale_body = 3,  ///< a body may have moved since its last known pose, and may now be a hit
  outdated = 4,    ///< the snapshot is too old; the library never returns this, but callers that check the age set it
  unmapped = 5,    ///< no map knows the space to be free, and SceneOptions::report_unmapped is set
  budget = 6,      ///< QueryScope::deadline passed before the query had examined everything
  /// Edges only: two shapes come so near to each other that EdgeRequest::tolerance does not suffice to prove that they
  /// stay apart.
  tolerance = 7,
  /// Edges only: a joint that turns freely turns by half a turn, so that both ways are equally short.
  half_turn = 8,
};

/// One body that a query hit. Points and normals are in the world frame. NaN: unknown or not applicable.
struct QueryHit {
  static constexpr double kUnknown = Proximity::kUnknown;  ///< NaN

  std::uint32_t body = 0;   ///< index into Structure::bodies
  std::uint32_t shape = 0;  ///< index of the nearest shape of the body; in a segment query: of the shape touched first
  Measure status = Measure::not_measured;  ///< result of the narrow phase, if the query is exact
  /// [m] Distance from the surface of the query to the box of the body, or to its shape if the query is exact. 0 if
  /// they overlap.
  double distance = 0.0;
  /// [m] Equal to `distance` if the two are apart, otherwise -depth. If the query is a sphere or a point, it is the
  /// signed distance of its center from the box or shape, minus the radius.
  double signed_distance = kUnknown;
  /// [m] Penetration depth, >= 0: a move of this length separates the query from the box, shape or cell of this hit. A
  /// mesh, or a body with other shapes that are penetrated deeper, may need a longer move. The depth of two boxes is
  /// always known. The depth is NaN in these cases:
  /// - The two are apart.
  /// - The query is inside a mesh. Exceptions, for exact queries and closed meshes: the depth of a point is known in
  ///   nearest(), unless it is larger than max_distance. The depth of a sphere is known if the center of the sphere is
  ///   at most one radius away from the surface of the mesh.
  /// - The narrow phase returns no depth.
  /// - The axis of a segment touches the box, or the hit is a cell that a segment touches.
  double depth = kUnknown;
  /// [m] Distance of the box or shape from the center of the query, or from the axis of a segment. In nearest() to a
  /// body, it is equal to `distance`.
  double center_distance = 0.0;
  /// [m] Segment only: how far along the segment its sphere first touches the body. A segment may enter an open mesh
  /// without touching it; then `along` is not larger than where the segment reaches the surface.
  double along = kUnknown;
  double cell_edge = kUnknown;  ///< [m] maps and clouds only: edge of the cell that was hit
  /// [m] The point of the box, or of the shape if the query is exact, that is nearest to the center or axis. If a
  /// segment touches a shape: the first point that it touches. NaN if the center is inside a shape.
  Eigen::Vector3d point = Eigen::Vector3d::Constant(kUnknown);
  /// [m] Only in nearest() to a body: the nearest point on that body.
  Eigen::Vector3d own_point = Eigen::Vector3d::Constant(kUnknown);
  /// Exact queries only: outward unit normal of the shape at `point`.
  Eigen::Vector3d normal = Eigen::Vector3d::Constant(kUnknown);
};

/// The answer to a query.
struct QueryAnswer {
  Verdict verdict = Verdict::unknown;  ///< the result in one word
  /// One hit per body, sorted by distance, then center_distance, then name. In a segment query: by `along`, then name.
  std::vector<QueryHit> hits;
  std::uint64_t total = 0;        ///< number of bodies hit; larger than hits.size() if QueryScope::limit cut the list
  bool examined_all = true;       ///< false: the deadline passed first, so there may be more hits or nearer ones
  Unknown because = Unknown::no;  ///< why the verdict is unknown
  std::string reason;             ///< the value of `because` as a sentence; empty if the verdict is not unknown
};

}  // namespace hgrid
