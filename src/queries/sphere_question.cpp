// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
//
// The queries for the bodies that touch a sphere, and for the bodies nearest to a point.
#include "hgrid_proximity/geometry/float_environment.h"
#include "hgrid_proximity/queries/query.h"
#include "queries/around_point.h"
#include "queries/nearest_rounds.h"

namespace hgrid {
namespace {

class SphereQuestion final : public AroundPoint {
 public:
  using AroundPoint::AroundPoint;

  bool gather(std::size_t round, std::vector<QueryHit>&, std::vector<ProxyId>& candidates) override {
    if (round == 0) snapshot.broadPhase().overlapping(local_, candidates);
    return round == 0;
  }
  bool hitsBox(ProxyId proxy, QueryHit& hit) const override {
    if (!touches(local_, boxOf(proxy))) return false;  // the grid stores the box grown by its margin
    measureBox(proxy, region_.radius, hit);
    return true;
  }
  bool hitsShape(ProxyId proxy, const NarrowPhase& exact, QueryHit& hit) const override {
    const Proximity found = center(exact).measure(snapshot, proxy, radius_);
    if (found.status == Measure::not_measured) return true;
    if (!(found.distance <= radius_)) return false;
    take(found, region_.radius, hit);
    return true;
  }
  bool hitsMap(const PlacedMap& map, QueryHit& hit) const override {
    return hitsNearestCell(map, radius_, region_.radius, hit);
  }
  bool hitsPlane(const PlacedPlane& plane, QueryHit& hit) const override {
    return hitsNearPlane(plane, radius_, region_.radius, hit);
  }
};

class NearestToPoint final : public AroundPoint {
 public:
  NearestToPoint(const Snapshot& asked, const QueryScope& given, const Eigen::Vector3d& point, double limit)
      : AroundPoint(asked, given, {point, limit}), rounds_(*this, point, 0.0, limit) {}

  std::size_t wanted() const override { return rounds_.wanted(); }
  bool gather(std::size_t round, std::vector<QueryHit>& hits, std::vector<ProxyId>& candidates) override {
    return rounds_.gather(round, hits, candidates);
  }
  bool hitsBox(ProxyId proxy, QueryHit& hit) const override {
    measureBox(proxy, 0.0, hit);
    return hit.distance <= rounds_.limit();
  }
  bool hitsShape(ProxyId proxy, const NarrowPhase& exact, QueryHit& hit) const override {
    const Proximity found = center(exact).measure(snapshot, proxy, rounds_.limit());
    if (found.status == Measure::not_measured) return true;
    take(found, 0.0, hit);
    return hit.distance <= rounds_.limit();
  }
  bool hitsMap(const PlacedMap& map, QueryHit& hit) const override {
    return hitsNearestCell(map, rounds_.limit(), 0.0, hit);
  }
  bool hitsPlane(const PlacedPlane& plane, QueryHit& hit) const override {
    return hitsNearPlane(plane, rounds_.limit(), 0.0, hit);
  }

 private:
  NearestRounds rounds_;
};

}  // namespace

QueryAnswer query(const Snapshot& snapshot, const Sphere& sphere, const QueryScope& scope) {
  const DefaultFloatEnvironment environment;
  checkQueryPoint(sphere.center, "the query's center");
  checkQueryLength(sphere.radius, "the query's radius");
  SphereQuestion question(snapshot, scope, sphere);
  return answerTo(question);
}

QueryAnswer nearest(const Snapshot& snapshot, const Eigen::Vector3d& point, double max_distance,
                    const QueryScope& scope) {
  const DefaultFloatEnvironment environment;
  checkQueryPoint(point, "the query's point");
  checkQueryLength(max_distance, "max_distance");
  NearestToPoint question(snapshot, scope, point, NearestRounds::limitOf(max_distance));
  return answerTo(question);
}

}  // namespace hgrid
