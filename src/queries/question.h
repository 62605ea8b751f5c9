// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

#include <algorithm>
#include <string>
#include <vector>

#include "geometry/infinity.h"
#include "queries/placed_map.h"
#include "queries/placed_plane.h"
#include "queries/probe.h"
#include "queries/time_budget.h"

namespace hgrid {

/// Checks a point of a query. `what` describes the point in error messages.
/// @throws Refusal nonfinite if a coordinate is not finite
/// @throws Refusal out_of_range if a coordinate is beyond -kQueryReach .. kQueryReach
void checkQueryPoint(const Eigen::Vector3d& point, const std::string& what);
/// Checks a length in a query. `what` describes the length in error messages.
/// @throws Refusal bad_geometry if the length is negative or not finite
/// @throws Refusal out_of_range if the length is greater than kQueryReach
void checkQueryLength(double length, const std::string& what);

/// @throws Refusal unknown_id if `respect_allowed` is not the index of a body
void checkScope(const Snapshot& snapshot, const QueryScope& scope);

/// Returns a bound [m] of the rounding error of a distance from a sphere of `radius` [m] around the point `at`. If a
/// query misses a body by less than this bound, the body counts as a hit.
inline double touchSlack(const Eigen::Vector3d& at, double radius) { return 1e-9 * (at.norm() + radius); }

/// Copies a result of the narrow phase into a hit. The first solid of the result is the query.
inline void describe(QueryHit& hit, const Proximity& found) {
  hit.status = found.status;
  hit.point = found.on_second;
  hit.normal = -found.normal;
}

/// Returns the signed distance [m] of two solids: their distance, or minus the penetration depth if they touch. NaN if
/// they touch and the depth is unknown.
inline double signedDistanceOf(const Proximity& found) {
  return found.distance > 0.0 ? found.distance : 0.0 - found.depth;
}

/// Returns the signed distance [m] of two boxes, or of a box and a point (a box of size 0). The caller already knows
/// `distance` [m], the distance of the two.
inline double signedDistance(const Eigen::AlignedBox3d& first, const Eigen::AlignedBox3d& second, double distance) {
  return distance > 0.0 ? distance : 0.0 - penetrationDepth(first, second);
}

/// Sets `distance`, `signed_distance` and `depth` of a hit.
/// @param signed_distance  [m] of the hit from the surface of the query; NaN if both touch and the depth is unknown
inline void setDistance(QueryHit& hit, double signed_distance) {
  hit.distance = std::max(0.0, signed_distance);  // this is 0 if signed_distance is NaN
  hit.signed_distance = signed_distance;
  hit.depth = signed_distance <= 0.0 ? 0.0 - signed_distance : QueryHit::kUnknown;
}

/// A query about one snapshot: for a sphere, a segment, a solid, or for the nearest bodies.
///
/// answerTo() finds the hits of a question. For this, a question gathers candidate boxes and decides which boxes,
/// shapes and cells of maps are hits. If there is no hit, answerTo() checks whether something may be in the region of
/// the question unseen. The region is the part of space in which a body would be a hit. A question is for one thread
/// and one call of answerTo().
class Question {
 public:
  virtual ~Question() = default;
  Question(const Question&) = delete;
  Question& operator=(const Question&) = delete;

  /// Replaces `candidates` with boxes that may be hits. It is called for round 0, 1, and so on. Each round returns
  /// other boxes.
  /// @param hits  the hits of the earlier rounds; the function may reorder them
  /// @returns false if there are no more boxes to look at; `candidates` is meaningless then
  virtual bool gather(std::size_t round, std::vector<QueryHit>& hits, std::vector<ProxyId>& candidates) = 0;
  /// Returns whether the box of a proxy is a hit. Sets all fields of `hit` except `body` and `shape`.
  virtual bool hitsBox(ProxyId proxy, QueryHit& hit) const = 0;
  /// Measures the shape of a proxy with the narrow phase. Returns whether the shape is a hit, and makes the values in
  /// `hit` exact. It is called only if the box of the proxy is a hit. Returns true if the shape cannot be measured.
  virtual bool hitsShape(ProxyId proxy, const NarrowPhase& exact, QueryHit& hit) const = 0;
  /// Returns whether a cell of a map is a hit. Sets `hit` to the nearest cell, or to the first cell along a segment.
  virtual bool hitsMap(const PlacedMap& map, QueryHit& hit) const = 0;
  /// Returns whether a plane is a hit. Sets all fields of `hit`, with exact values if the query is exact.
  virtual bool hitsPlane(const PlacedPlane& plane, QueryHit& hit) const = 0;
  /// Returns whether hit `a` comes before hit `b` in the answer. If a body has several hits, only the first is kept.
  virtual bool goesBefore(const QueryHit& a, const QueryHit& b) const;
  /// Largest number of hits that the question asks for; 0: all.
  virtual std::size_t wanted() const { return 0; }

  /// Returns whether the box of a proxy is at most `distance` [m] from the region.
  virtual bool isBoxWithin(ProxyId proxy, double distance) const = 0;
  /// Returns whether the shape of a proxy, as measured by the narrow phase, is at most `distance` [m] from the region.
  /// Returns true if the shape cannot be measured.
  virtual bool isShapeWithin(ProxyId proxy, double distance, const NarrowPhase& exact) const = 0;
  /// Returns whether an occupied cell of a map is at most `distance` [m] from the region.
  virtual bool isCellWithin(const PlacedMap& map, double distance) const = 0;
  /// Returns whether the region touches a sphere. The sphere is in the world frame.
  virtual bool isTouchedBy(const Sphere& sphere) const = 0;
  /// Returns whether a map knows the whole region to be free.
  virtual bool isFreeIn(const PlacedMap& map, const UnmappedSpace& unmapped) const = 0;
  /// The body from which the question measures distances, or Structure::kNone.
  virtual std::uint32_t askingBody() const { return Structure::kNone; }

  const Snapshot& snapshot;
  const QueryScope& scope;
  mutable TimeBudget time;  // checked before each measurement; when it is over, all remaining bodies count as not hit

 protected:
  Question(const Snapshot& asked, const QueryScope& given) : snapshot(asked), scope(given), time(given.deadline) {}
  const Structure& structure() const { return snapshot.structure(); }
  const Eigen::Vector3d& origin() const { return snapshot.origin(); }
  const Aabb& boxOf(ProxyId proxy) const { return snapshot.boxes()[proxy]; }
  bool isExact() const { return scope.exact != nullptr; }
  static bool isWithin(const Proximity& found, double limit) {
    return found.status == Measure::not_measured || found.distance <= limit;
  }
};

/// Keeps only the first hit of each body, in the order of Question::goesBefore(), and sorts the hits in this order.
void sortOnePerBody(const Question& question, std::vector<QueryHit>& hits);

/// Finds the hits of a question and decides the verdict.
QueryAnswer answerTo(Question& question);

/// Checks whether a question without hits may answer CLEAR. If something prevents that, sets the reason in the answer.
/// If not, changes nothing.
void noteDoubt(const Question& question, QueryAnswer& answer);

}  // namespace hgrid
