// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
//
// The query for the bodies nearest to a body.
#include <algorithm>
#include <optional>

#include "hgrid_proximity/geometry/float_environment.h"
#include "hgrid_proximity/queries/query.h"
#include "hgrid_proximity/refusal.h"
#include "maps/map_gap.h"
#include "queries/nearest_rounds.h"

namespace hgrid {
namespace {

/// Returns the box around all boxes of a body, relative to the origin of the snapshot.
Eigen::AlignedBox3d boundsOf(const Snapshot& snapshot, std::uint32_t body) {
  const std::vector<ProxyId>& first = snapshot.structure().first_proxy;
  Eigen::AlignedBox3d bounds;
  for (ProxyId proxy = first[body]; proxy < first[body + 1]; ++proxy) {
    bounds.extend(inDouble(snapshot.boxes()[proxy]));
  }
  return bounds;
}

/// Finds the bodies that are at most `limit` [m] away from a body at its last known pose.
class NearestToBody final : public Question {
 public:
  NearestToBody(const Snapshot& asked, const QueryScope& given, std::uint32_t from, double limit,
                const Eigen::AlignedBox3d& bounds)
      : Question(asked, given),
        from_(from),
        body_(structure().bodies[from]),
        limit_(limit),
        rounds_(*this, origin() + 0.5 * (bounds.min() + bounds.max()), 0.5 * (bounds.max() - bounds.min()).norm(),
                limit) {}

  std::uint32_t askingBody() const override { return from_; }
  std::size_t wanted() const override { return rounds_.wanted(); }
  bool gather(std::size_t round, std::vector<QueryHit>& hits, std::vector<ProxyId>& candidates) override {
    return rounds_.gather(round, hits, candidates);
  }
  bool hitsBox(ProxyId proxy, QueryHit& hit) const override;
  bool hitsShape(ProxyId proxy, const NarrowPhase& exact, QueryHit& hit) const override;
  bool hitsMap(const PlacedMap& map, QueryHit& hit) const override;
  bool hitsPlane(const PlacedPlane& plane, QueryHit& hit) const override;

  bool isBoxWithin(ProxyId proxy, double distance) const override {
    return anyOwnShape([&](ProxyId own) { return snapshot.gapOfProxies(own, proxy) <= limit_ + distance; });
  }
  bool isShapeWithin(ProxyId proxy, double distance, const NarrowPhase& exact) const override {
    return anyOwnShape([&](ProxyId own) {
      return !shapeOf(own).solid ||
             isWithin(probe(own, exact).measure(snapshot, proxy, limit_ + distance), limit_ + distance);
    });
  }
  bool isCellWithin(const PlacedMap& map, double distance) const override {
    std::vector<NearVoxel> near;
    return anyOwnShape([&](ProxyId own) {
      map.cells.grid->nearest(boxIn(map, own), 1, limit_ + distance, near);
      return !near.empty();
    });
  }
  bool isTouchedBy(const Sphere& sphere) const override {
    const double limit = limit_ + sphere.radius + snapshot.poses()[from_].reach;
    return anyOwnShape([&](ProxyId own) {
      return distance(boxOf(own), sphere.center - origin()) <= limit + touchSlack(sphere.center, limit);
    });
  }
  bool isFreeIn(const PlacedMap& map, const UnmappedSpace& unmapped) const override;

 private:
  ProxyId firstOwn() const { return structure().first_proxy[from_]; }
  ProxyId endOfOwn() const { return structure().first_proxy[from_ + 1]; }
  /// Returns whether `claim` returns true for at least one proxy of the asking body.
  template <class Claim>
  bool anyOwnShape(const Claim& claim) const {
    for (ProxyId own = firstOwn(); own < endOfOwn(); ++own) {
      if (claim(own)) return true;
    }
    return false;
  }
  const BodyShape& shapeOf(ProxyId own) const { return body_.shapes[own - firstOwn()]; }
  /// Returns a probe that measures one shape of the asking body against other shapes. The shape must have a solid.
  Probe probe(ProxyId own, const NarrowPhase& narrow_phase) const {
    const BodyShape& shape = shapeOf(own);
    return {narrow_phase, *shape.solid, snapshot.poses()[from_].world_from_body * shape.body_from_shape, shape.padding,
            true};
  }
  Eigen::AlignedBox3d boxIn(const PlacedMap& map, ProxyId own) const {
    return boxInMap(map.map_from_world, boxOf(own), origin());
  }
  void takeNearerBox(ProxyId own, ProxyId proxy, double gap, QueryHit& hit) const;
  static void takeNearer(const Proximity& found, QueryHit& hit);
  double farthest(const QueryHit& nearest) const;

  const std::uint32_t from_;
  const Body& body_;
  const double limit_;  // [m] bodies farther away are no hits
  NearestRounds rounds_;
};

/// If `gap`, the distance of the two boxes, is smaller than the distance of `hit`, sets `hit` from the two boxes.
void NearestToBody::takeNearerBox(ProxyId own, ProxyId proxy, double gap, QueryHit& hit) const {
  if (!(gap < hit.distance)) return;
  const Eigen::AlignedBox3d own_box = inDouble(boxOf(own)), box = inDouble(boxOf(proxy));
  const BoxPoints nearest = nearestPoints(own_box, box);
  setDistance(hit, signedDistance(own_box, box, gap));
  hit.center_distance = gap;
  hit.own_point = origin() + nearest.on_first;
  hit.point = origin() + nearest.on_second;
}

/// If the measured distance is smaller than the distance of `hit`, sets `hit` from the measurement. The first shape of
/// the measurement belongs to the asking body.
void NearestToBody::takeNearer(const Proximity& found, QueryHit& hit) {
  if (!(found.distance < hit.distance)) return;
  describe(hit, found);
  setDistance(hit, signedDistanceOf(found));
  hit.center_distance = found.distance;
  hit.own_point = found.on_first;
}

bool NearestToBody::hitsBox(ProxyId proxy, QueryHit& hit) const {
  if (hit.body == from_) return false;
  hit.distance = kInfinity;
  for (ProxyId own = firstOwn(); own < endOfOwn(); ++own) {
    takeNearerBox(own, proxy, distance(boxOf(own), boxOf(proxy)), hit);
  }
  return hit.distance <= limit_;
}

bool NearestToBody::hitsShape(ProxyId proxy, const NarrowPhase& exact, QueryHit& hit) const {
  hit.distance = kInfinity;
  for (ProxyId own = firstOwn(); own < endOfOwn(); ++own) {
    const double gap = distance(boxOf(own), boxOf(proxy)), most = std::min(limit_, hit.distance);
    if (gap > most) continue;
    Proximity found;
    if (shapeOf(own).solid) found = probe(own, exact).measure(snapshot, proxy, most);
    if (found.status == Measure::not_measured) {
      takeNearerBox(own, proxy, gap, hit);
    } else {
      takeNearer(found, hit);
    }
  }
  return hit.distance <= limit_;
}

bool NearestToBody::hitsPlane(const PlacedPlane& plane, QueryHit& hit) const {
  hit.distance = kInfinity;
  for (ProxyId own = firstOwn(); own < endOfOwn(); ++own) {
    Proximity found;
    if (isExact() && shapeOf(own).solid) {
      const Probe shape = probe(own, *scope.exact);
      found =
          shape.measure(*scope.exact->plane(), plane.world_from_plane, plane.padding, std::min(limit_, hit.distance));
    } else {
      const Eigen::Vector3d corner = deepestCorner(plane.half_space, inDouble(boxOf(own)));
      const double signed_distance = plane.signedDistanceOf(corner);
      found.distance = std::max(0.0, signed_distance);
      if (signed_distance <= 0.0) found.depth = 0.0 - signed_distance;
      found.on_first = origin() + corner;
      found.on_second = found.on_first - found.distance * plane.half_space.normal;
    }
    takeNearer(found, hit);
  }
  hit.body = plane.body;
  hit.shape = plane.shape;
  return hit.distance <= limit_;
}

/// Returns the limit [m] of the search for cells that are nearer than `nearest`. kNoFurther ends the search.
double NearestToBody::farthest(const QueryHit& nearest) const {
  return nearest.distance > 0.0 ? std::min(limit_, nearest.distance) : kNoFurther;
}

bool NearestToBody::hitsMap(const PlacedMap& map, QueryHit& hit) const {
  hit.distance = kInfinity;
  for (ProxyId own = firstOwn(); own < endOfOwn() && farthest(hit) >= 0.0; ++own) {
    const Eigen::AlignedBox3d own_box = boxIn(map, own);
    std::optional<Probe> shape;
    if (isExact() && shapeOf(own).solid) shape.emplace(probe(own, *scope.exact));
    map.cells.grid->visitNear(own_box, farthest(hit), [&](const Voxel& voxel, double gap) {
      if (time.isOver(TimeBudget::Step::slow)) return kNoFurther;
      Proximity found;
      if (shape) {
        found = shape->measure(map.solidOf(voxel), map.worldFromCube(voxel), 0.0, farthest(hit));
      } else {
        const BoxPoints nearest = nearestPoints(own_box, map.cubeOf(voxel));
        found.distance = gap;
        if (!(gap > 0.0)) found.depth = penetrationDepth(own_box, map.cubeOf(voxel));
        found.on_first = map.world_from_map * nearest.on_first;
        found.on_second = map.world_from_map * nearest.on_second;
      }
      if (found.distance < hit.distance) hit.cell_edge = map.edgeOf(voxel);
      takeNearer(found, hit);
      return farthest(hit);
    });
  }
  hit.body = map.body;
  return hit.distance <= limit_;
}

bool NearestToBody::isFreeIn(const PlacedMap& map, const UnmappedSpace& unmapped) const {
  std::vector<NearVoxel> near;
  return !anyOwnShape([&](ProxyId own) {
    const Eigen::AlignedBox3d box = boxIn(map, own);
    const double distance = limit_ + map.reach + snapshot.poses()[from_].reach + touchSlack(box.center(), limit_);
    if (!unmapped.extent.contains(grown(box, distance))) return true;
    unmapped.cells.nearest(box, 1, distance, near);
    return !near.empty();
  });
}

}  // namespace

QueryAnswer nearest(const Snapshot& snapshot, std::uint32_t from, double max_distance, const QueryScope& scope) {
  const DefaultFloatEnvironment environment;
  checkQueryLength(max_distance, "max_distance");
  const Body& body = snapshot.structure().bodies[from];
  if (snapshot.structure().isMap(from)) {
    const std::string kind = body.kind == BodyKind::map ? "map" : "cloud";
    throw Refusal(Code::unsupported, "'" + body.name + "' is a " + kind + "; ask from a link or an obstacle");
  }
  if (snapshot.poses()[from].state == Freshness::unplaced || body.shapes.empty()) {
    throw Refusal(Code::not_ready, "body '" + body.name + "' has no " + (body.shapes.empty() ? "shapes" : "pose") +
                                       "; distances from it need a pose and a shape");
  }
  if (snapshot.structure().hasPlane(from)) {
    throw Refusal(Code::unsupported, "'" + body.name + "' has a plane, which has no end; ask from another body");
  }
  NearestToBody question(snapshot, scope, from, NearestRounds::limitOf(max_distance), boundsOf(snapshot, from));
  return answerTo(question);
}

}  // namespace hgrid
