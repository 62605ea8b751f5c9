// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

#include <algorithm>
#include <limits>
#include <string>
#include <vector>

#include "queries/placed_map.h"
#include "queries/probe.h"
#include "queries/time_budget.h"

namespace hgrid {

/// @throws Refusal nonfinite, out_of_range: naming `what` and the value
void checkQueryPoint(const Eigen::Vector3d& point, const std::string& what);
/// @throws Refusal bad_geometry, out_of_range: naming `what` and the value
void checkQueryLength(double length, const std::string& what);

/// @throws Refusal unknown_id if `respect_allowed` is not the index of a body
void checkScope(const Snapshot& snapshot, const QueryScope& scope);

/// [m] Bounds what rounding may take from a distance at such coordinates. A query that misses by less counts as a hit.
inline double touchSlack(const Eigen::Vector3d& at, double radius) { return 1e-9 * (at.norm() + radius); }

/// Copies what the narrow phase found between a query (the first solid) and a shape.
inline void describe(QueryHit& hit, const Proximity& found) {
  hit.status = found.status;
  hit.point = found.on_second;
  hit.normal = -found.normal;
}

/// [m] Minus the depth if two things touch, otherwise their distance. NaN if they touch at an unknown depth.
inline double signedDistanceOf(const Proximity& found) {
  return found.distance > 0.0 ? found.distance : 0.0 - found.depth;
}

/// The same for two boxes, or a box and a point (a box without size), whose distance [m] is known.
inline double signedDistance(const Eigen::AlignedBox3d& first, const Eigen::AlignedBox3d& second, double distance) {
  return distance > 0.0 ? distance : 0.0 - penetrationDepth(first, second);
}

/// Sets the distances from the query's surface. @param signed_distance  [m] NaN if they touch at an unknown depth
inline void setDistance(QueryHit& hit, double signed_distance) {
  hit.distance = std::max(0.0, signed_distance);  // 0 for NaN
  hit.signed_distance = signed_distance;
  hit.depth = signed_distance <= 0.0 ? 0.0 - signed_distance : QueryHit::kUnknown;
}

/// A question that is asked of one snapshot: a sphere, a segment, a solid, or what is nearest to something.
///
/// answerTo() finds what it hits. For that, a question gathers candidate boxes, then tells how it meets boxes, shapes
/// and the cells of maps. If it hits nothing, answerTo() asks what may be in its region unseen: the part of the world
/// in which a body would be a hit. One thread, one call of answerTo().
class Question {
 public:
  virtual ~Question() = default;
  Question(const Question&) = delete;
  Question& operator=(const Question&) = delete;

  /// Replaces `candidates` with boxes that may be hits. Called for round 0, 1, ..., each time for other boxes.
  /// @param hits  what was found in the rounds before; may be reordered
  /// @returns false if there are no more boxes to look at; `candidates` is meaningless then
  virtual bool gather(std::size_t round, std::vector<QueryHit>& hits, std::vector<ProxyId>& candidates) = 0;
  /// Whether a box is a hit, measured by boxes. Fills in all of `hit` but its body and shape.
  virtual bool hitsBox(ProxyId proxy, QueryHit& hit) const = 0;
  /// Whether the shape in a box that is a hit is one too, measured by the narrow phase. Improves `hit`.
  /// A shape that cannot be measured is a hit as its box is.
  virtual bool hitsShape(ProxyId proxy, const NarrowPhase& exact, QueryHit& hit) const = 0;
  /// Whether a cell of a map is a hit. Replaces `hit` with the nearest cell, or with the first along a segment.
  virtual bool hitsMap(const PlacedMap& map, QueryHit& hit) const = 0;
  /// The order of hits: the first of two on one body is kept, the answer lists them in this order.
  virtual bool goesBefore(const QueryHit& a, const QueryHit& b) const;
  /// Number of hits that the question asks for; 0: all.
  virtual std::size_t wanted() const { return 0; }

  /// Whether a box is at most `distance` [m] from the region.
  virtual bool isBoxWithin(ProxyId proxy, double distance) const = 0;
  /// Whether the shape in a box is, measured by the narrow phase. True if the shape cannot be measured.
  virtual bool isShapeWithin(ProxyId proxy, double distance, const NarrowPhase& exact) const = 0;
  /// Whether an occupied cell of a map is.
  virtual bool isCellWithin(const PlacedMap& map, double distance) const = 0;
  /// Whether the region touches a sphere of the world.
  virtual bool isTouchedBy(const Sphere& sphere) const = 0;
  /// Whether a map knows all of the region to be free.
  virtual bool isFreeIn(const PlacedMap& map, const UnmappedSpace& unmapped) const = 0;
  /// The body that the question asks from, or Structure::kNone.
  virtual std::uint32_t askingBody() const { return Structure::kNone; }

  const Snapshot& snapshot;
  const QueryScope& scope;
  mutable TimeBudget time;  // whoever examines something asks it first; what it leaves out counts as not hit

 protected:
  static constexpr double kInfinity = std::numeric_limits<double>::infinity();

  Question(const Snapshot& asked, const QueryScope& given) : snapshot(asked), scope(given), time(given.deadline) {}
  const Structure& structure() const { return snapshot.structure(); }
  const Eigen::Vector3d& origin() const { return snapshot.origin(); }
  const Aabb& boxOf(ProxyId proxy) const { return snapshot.boxes()[proxy]; }
  bool isExact() const { return scope.exact != nullptr; }
  static bool isWithin(const Proximity& found, double limit) {
    return found.status == Measure::not_measured || found.distance <= limit;
  }
};

/// Keeps one hit per body, the first in the question's order, and sorts them in that order.
void sortOnePerBody(const Question& question, std::vector<QueryHit>& hits);

/// Finds what a question hits and decides the verdict.
QueryAnswer answerTo(Question& question);

/// Notes in the answer why a question that hit nothing is not CLEAR. Changes nothing if it is.
void noteDoubt(const Question& question, QueryAnswer& answer);

}  // namespace hgrid
