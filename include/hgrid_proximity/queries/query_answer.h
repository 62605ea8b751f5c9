// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <string>
#include <vector>

#include "hgrid_proximity/narrow/narrow_phase.h"

namespace hgrid {

/// What a query says: a body is there (hit), no body that it asks about can be there (clear), or neither is known.
enum class Verdict : std::uint8_t { unknown = 0, clear = 1, hit = 2 };

/// Why a verdict is unknown. The numbers are stable: interfaces outside of the library send them.
enum class Unknown : std::uint8_t {
  no = 0,          ///< the verdict is not unknown
  refused = 1,     ///< the question is not valid; the library throws a Refusal instead
  incomplete = 2,  ///< a source lacks something that may be there, or nothing bounds where a body can be
  stale_body = 3,  ///< a body may have moved there since its pose was last known
  outdated = 4,    ///< the snapshot is too old; for callers that judge its age
  unmapped = 5,    ///< no map knows the space to be free, and maps are to report that
  budget = 6,      ///< QueryScope::deadline passed before everything was examined
};

/// One body that a query hit. Points and normals are in the world frame. NaN: unknown or not applicable.
struct QueryHit {
  static constexpr double kUnknown = Proximity::kUnknown;

  std::uint32_t body = 0;   ///< index into Structure::bodies
  std::uint32_t shape = 0;  ///< index of the nearest of its shapes; of a segment query: of the shape met first
  Measure status = Measure::not_measured;  ///< result of the narrow phase, if the query is exact
  /// [m] from the query's surface to the body's box, or to its shape if the query is exact; 0 where they overlap.
  double distance = 0.0;
  /// [m] As `distance`, but -depth where they overlap. Of a sphere or point and a shape: the distance of the shape from
  /// the center minus the radius.
  double signed_distance = kUnknown;
  /// [m] Penetration depth, >= 0: a move of this length separates the query from the box, shape or cell that this hit
  /// names. The move may have to be longer for a mesh, and for a body of which other shapes are penetrated deeper. NaN
  /// where they are apart, and where the depth is unknown: inside a mesh, where the axis of a segment meets the box,
  /// for the cell that a segment meets, and where the narrow phase gives none. Two boxes always have one.
  double depth = kUnknown;
  /// [m] As `distance`, but from the query's center, or from the axis of a segment. Between two bodies: `distance`.
  double center_distance = 0.0;
  /// [m] Segment only: how far along the segment its sphere first touches. In an open mesh, which the segment may enter
  /// without a touch, it is no later than where the segment meets the surface.
  double along = kUnknown;
  double cell_edge = kUnknown;  ///< [m] maps and clouds only: edge of the cell that was hit
  /// [m] The point of the box, or of the shape if the query is exact, that is nearest to the center or axis. Where a
  /// segment meets a shape: the point that it meets first. NaN inside a shape.
  Eigen::Vector3d point = Eigen::Vector3d::Constant(kUnknown);
  /// [m] Nearest to a body only: the nearest point on that body.
  Eigen::Vector3d own_point = Eigen::Vector3d::Constant(kUnknown);
  /// Exact only: outward unit normal of the shape at `point`.
  Eigen::Vector3d normal = Eigen::Vector3d::Constant(kUnknown);
};

/// What a query found.
struct QueryAnswer {
  Verdict verdict = Verdict::unknown;
  /// One per body, by distance, then center_distance, then name. Of a segment query: by `along`, then name.
  std::vector<QueryHit> hits;
  std::uint64_t total = 0;        ///< bodies hit; more than hits.size() if QueryScope::limit cut the list
  bool examined_all = true;       ///< false: the deadline passed first, so there may be more hits, or nearer ones
  Unknown because = Unknown::no;  ///< why the verdict is unknown
  std::string reason;             ///< the same as a sentence; empty if the verdict is not unknown
};

}  // namespace hgrid
