// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
//
// The query for the bodies that touch a solid at any pose, such as a box.
#include <optional>

#include "hgrid_proximity/geometry/float_environment.h"
#include "hgrid_proximity/geometry/oriented_box.h"
#include "hgrid_proximity/queries/query.h"
#include "hgrid_proximity/refusal.h"
#include "maps/map_gap.h"
#include "queries/question.h"

namespace hgrid {
namespace {

class SolidQuestion final : public Question {
 public:
  /// @param shape  the shape from which `solid` was created
  SolidQuestion(const Snapshot& asked, const QueryScope& given, const NarrowPhase& narrow_phase,
                std::shared_ptr<const Solid> solid, const Shape& shape, const Pose& world_from_shape, double padding)
      : Question(asked, given),
        narrow_phase_(narrow_phase),
        solid_(std::move(solid)),
        shape_(shape),
        world_from_shape_(world_from_shape),
        center_(world_from_shape.translation()),
        padding_(padding),
        radius_(shape.reach() + padding),
        slack_(touchSlack(center_, 2.0 * radius_)) {
    if (shape.kind() != ShapeKind::box || padding > 0.0) return;
    const std::vector<double> size = shape.dimensions();
    box_ = OrientedBox{world_from_shape, {size[0], size[1], size[2]}};
  }

  bool gather(std::size_t round, std::vector<QueryHit>&, std::vector<ProxyId>& candidates) override {
    if (round == 0) snapshot.broadPhase().overlapping(boxAround(2.0 * slack_), candidates);
    return round == 0;
  }
  bool hitsBox(ProxyId proxy, QueryHit& hit) const override;
  bool hitsShape(ProxyId proxy, const NarrowPhase& exact, QueryHit& hit) const override;
  bool hitsMap(const PlacedMap& map, QueryHit& hit) const override;
  bool hitsPlane(const PlacedPlane& plane, QueryHit& hit) const override;

  bool isBoxWithin(ProxyId proxy, double distance) const override {
    return measureBox(worldBoxOf(proxy), slack_ + distance).distance <= slack_ + distance;
  }
  bool isShapeWithin(ProxyId proxy, double distance, const NarrowPhase& exact) const override {
    return isWithin(probe(exact).measure(snapshot, proxy, slack_ + distance), slack_ + distance);
  }
  bool isCellWithin(const PlacedMap& map, double distance) const override {
    return meetsCell(map, *map.cells.grid, distance);
  }
  bool isTouchedBy(const Sphere& sphere) const override {
    const double limit = slack_ + touchSlack(sphere.center, sphere.radius);
    const Pose world_from_sphere(Eigen::Translation3d(sphere.center));
    return probe(narrow_phase_).measure(*narrow_phase_.point(), world_from_sphere, sphere.radius, limit).distance <=
           limit;
  }
  bool isFreeIn(const PlacedMap& map, const UnmappedSpace& unmapped) const override;

 private:
  /// Returns a box around the solid grown by `by` [m], relative to the origin of the snapshot.
  Aabb boxAround(double by) const { return hgrid::boxOf(shape_, world_from_shape_, padding_ + by, origin()); }
  Probe probe(const NarrowPhase& narrow_phase) const { return {narrow_phase, *solid_, world_from_shape_, padding_}; }
  Probe describing(const NarrowPhase& narrow_phase) const {
    return {narrow_phase, *solid_, world_from_shape_, padding_, true};
  }
  /// Returns the box of a proxy in the world frame.
  OrientedBox worldBoxOf(ProxyId proxy) const {
    const Eigen::AlignedBox3d box = inDouble(boxOf(proxy));
    return {Pose(Eigen::Translation3d(origin() + 0.5 * (box.min() + box.max()))), box.max() - box.min()};
  }
  Proximity measureBox(const OrientedBox& box, double up_to) const {
    return probe(narrow_phase_).measure(*narrow_phase_.block(box.size), box.world_from_box, 0.0, up_to);
  }
  double depthIn(const OrientedBox& box, const Proximity& found) const;
  /// Sets the distances of a hit. A solid touches every body that it hits, so `distance` is 0 even if rounding gave
  /// more.
  static void setDistance(QueryHit& hit, const Proximity& found) {
    hgrid::setDistance(hit, signedDistanceOf(found));
    hit.distance = 0.0;
  }
  Proximity measureCell(const PlacedMap& map, const Voxel& voxel, double up_to) const {
    return probe(narrow_phase_).measure(map.solidOf(voxel), map.worldFromCube(voxel), 0.0, up_to);
  }
  bool meetsCell(const PlacedMap& map, const StaticGrid& cells, double distance) const;

  const NarrowPhase& narrow_phase_;
  const std::shared_ptr<const Solid> solid_;
  const Shape shape_;
  const Pose world_from_shape_;
  const Eigen::Vector3d center_;    // [m, world] origin of the shape
  const double padding_;            // [m] how much the shape is grown
  const double radius_;             // [m] distance from the center to the farthest point of the shape, padding included
  const double slack_;              // [m] rounding error of a distance
  std::optional<OrientedBox> box_;  // the solid, if it is a box without padding
};

/// Returns the penetration depth [m] of the solid and a box. If the solid is not a box, this is the depth in `found`,
/// the result of the narrow phase. That depth may be NaN.
double SolidQuestion::depthIn(const OrientedBox& box, const Proximity& found) const {
  return box_ && !(found.distance > 0.0) ? penetrationDepth(*box_, box) : found.depth;
}

bool SolidQuestion::hitsBox(ProxyId proxy, QueryHit& hit) const {
  const OrientedBox box = worldBoxOf(proxy);
  Proximity found = measureBox(box, slack_);
  if (!(found.distance <= slack_)) return false;
  found.depth = depthIn(box, found);
  setDistance(hit, found);
  hit.center_distance = distance(boxOf(proxy), center_ - origin());
  hit.point = nearestPoint(boxOf(proxy), center_ - origin()) + origin();
  return true;
}

bool SolidQuestion::hitsShape(ProxyId proxy, const NarrowPhase& exact, QueryHit& hit) const {
  const Proximity found = describing(exact).measure(snapshot, proxy, slack_);
  if (found.status == Measure::not_measured) return true;
  if (!(found.distance <= slack_)) return false;
  const Probe center{exact, *exact.point(), Pose(Eigen::Translation3d(center_))};
  const Proximity from_center = center.measure(snapshot, proxy, kInfinity);
  setDistance(hit, found);
  describe(hit, from_center);
  hit.status = found.status;
  hit.center_distance = from_center.distance;
  return true;
}

/// Visits the cells in the order of their distance from the center. The hit is the nearest cell that the solid touches.
bool SolidQuestion::hitsMap(const PlacedMap& map, QueryHit& hit) const {
  const Eigen::Vector3d center = map.map_from_world * center_;
  const double most = radius_ + slack_;
  std::optional<NearVoxel> met;
  Proximity contact;
  map.cells.grid->visitNear(Eigen::AlignedBox3d(center), most, [&](const Voxel& voxel, double distance) {
    if (time.isOver(TimeBudget::Step::slow)) return kNoFurther;
    const Proximity found = measureCell(map, voxel, slack_);
    if (found.distance <= slack_ && (!met || distance < met->distance)) {
      met = NearVoxel{voxel, distance};
      contact = found;
    }
    return !met ? most : met->distance > 0.0 ? met->distance : kNoFurther;
  });
  if (!met) return false;
  hit = map.hitOf(met->voxel, center, met->distance, isExact());
  if (!box_) {
    contact = describing(narrow_phase_).measure(map.solidOf(met->voxel), map.worldFromCube(met->voxel), 0.0, slack_);
  }
  contact.depth = depthIn({map.worldFromCube(met->voxel), Eigen::Vector3d::Constant(hit.cell_edge)}, contact);
  setDistance(hit, contact);
  if (isExact()) hit.status = Measure::contact;
  return true;
}

bool SolidQuestion::hitsPlane(const PlacedPlane& plane, QueryHit& hit) const {
  const Proximity found =
      probe(narrow_phase_).measure(*narrow_phase_.plane(), plane.world_from_plane, plane.padding, slack_);
  if (!(found.distance <= slack_)) return false;
  hit = plane.hitOf(center_ - origin(), origin(), isExact());
  setDistance(hit, found);
  if (isExact()) hit.status = found.status;
  return true;
}

/// Returns whether one of `cells` is at most `distance` [m] from the solid. The cells are in the frame of the map.
bool SolidQuestion::meetsCell(const PlacedMap& map, const StaticGrid& cells, double distance) const {
  const double limit = slack_ + distance;
  bool met = false;
  cells.visitNear(Eigen::AlignedBox3d(Eigen::Vector3d(map.map_from_world * center_)), radius_ + limit,
                  [&](const Voxel& voxel, double) {
                    if (time.isOver(TimeBudget::Step::slow)) return kNoFurther;
                    met = met || measureCell(map, voxel, limit).distance <= limit;
                    return met ? kNoFurther : radius_ + limit;
                  });
  return met;
}

bool SolidQuestion::isFreeIn(const PlacedMap& map, const UnmappedSpace& unmapped) const {
  const Pose map_from_shape = map.map_from_world * world_from_shape_;
  const Eigen::Vector3d center = map.map_from_world * center_;
  const Eigen::AlignedBox3d around =
      inDouble(hgrid::boxOf(shape_, map_from_shape, padding_ + map.reach + slack_, center));
  return unmapped.extent.contains(Eigen::AlignedBox3d(around.min() + center, around.max() + center)) &&
         !meetsCell(map, unmapped.cells, map.reach);
}

}  // namespace

QueryAnswer query(const Snapshot& snapshot, const QueryBox& box, const NarrowPhase& narrow_phase,
                  const QueryScope& scope) {
  const DefaultFloatEnvironment environment;
  checkQueryPoint(box.world_from_box.translation(), "the query's center");
  for (int axis = 0; axis < 3; ++axis) checkQueryLength(box.size[axis], "a side of the query's box");
  const ShapeLimits any_size{0.0, kQueryReach};
  SolidQuestion question(snapshot, scope, narrow_phase, narrow_phase.block(box.size), Shape::box(box.size, any_size),
                         box.world_from_box, 0.0);
  return answerTo(question);
}

QueryAnswer query(const Snapshot& snapshot, const QueryShape& shape, NarrowPhase& narrow_phase,
                  const QueryScope& scope) {
  const DefaultFloatEnvironment environment;
  checkQueryPoint(shape.world_from_shape.translation(), "the query's center");
  checkQueryLength(shape.padding, "the padding of the query's shape");
  if (shape.shape.kind() == ShapeKind::plane) {
    throw Refusal(Code::unsupported,
                  "the query's shape is a plane; it must be a bounded shape, for example a large box");
  }
  const std::shared_ptr<const Solid> solid = narrow_phase.solidOf(shape.shape);
  SolidQuestion question(snapshot, scope, narrow_phase, solid, shape.shape, shape.world_from_shape, shape.padding);
  return answerTo(question);
}

}  // namespace hgrid
