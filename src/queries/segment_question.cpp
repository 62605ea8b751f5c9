// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
//
// The query for the bodies that a segment with a radius touches.
#include <algorithm>
#include <cmath>

#include "geometry/rotation.h"
#include "geometry/rounding.h"
#include "hgrid_proximity/geometry/float_environment.h"
#include "hgrid_proximity/queries/query.h"
#include "queries/question.h"

namespace hgrid {
namespace {

constexpr int kMostSteps = 500;  // maximum number of steps in firstTouch()

/// Returns the pose at which a needle (a segment along z, centered in its frame) lies on the segment.
Pose poseAlong(const Segment& segment) {
  Pose pose = Pose::Identity();
  const Eigen::Vector3d step = segment.to - segment.from;
  pose.translation() = segment.from + 0.5 * step;
  pose.linear() = rotationAlong(step);
  return pose;
}

/// Returns the outward normal of the face through which a line in `direction` enters a cube at the point `at`. NaN if
/// `at` is not on such a face.
Eigen::Vector3d normalWhereEntered(const Eigen::AlignedBox3d& cube, const Eigen::Vector3d& at,
                                   const Eigen::Vector3d& direction) {
  constexpr double kOnFace = 1e-6;  // [edge of the cube]
  Eigen::Vector3d normal = Eigen::Vector3d::Constant(QueryHit::kUnknown);
  double nearest = kOnFace * cube.sizes().maxCoeff();
  for (int axis = 0; axis < 3; ++axis) {
    if (direction[axis] == 0.0) continue;
    const double off = std::abs(at[axis] - (direction[axis] > 0.0 ? cube.min()[axis] : cube.max()[axis]));
    if (off > nearest) continue;
    nearest = off;
    normal = Eigen::Vector3d::Unit(axis) * (direction[axis] > 0.0 ? -1.0 : 1.0);
  }
  return normal;
}

class SegmentQuestion final : public Question {
 public:
  SegmentQuestion(const Snapshot& asked, const QueryScope& given, const Segment& segment)
      : Question(asked, given),
        segment_(segment),
        local_{segment.from - origin(), segment.to - origin(), segment.radius},
        length_((segment.to - segment.from).norm()),
        slack_(touchSlack(segment.from, segment.radius + length_)),
        world_from_axis_(length_ > 0.0 ? poseAlong(segment) : Pose(Eigen::Translation3d(segment.from))) {}

  bool gather(std::size_t round, std::vector<QueryHit>&, std::vector<ProxyId>& candidates) override;
  bool hitsBox(ProxyId proxy, QueryHit& hit) const override;
  bool hitsShape(ProxyId proxy, const NarrowPhase& exact, QueryHit& hit) const override;
  bool hitsMap(const PlacedMap& map, QueryHit& hit) const override;
  bool hitsPlane(const PlacedPlane& plane, QueryHit& hit) const override;
  bool goesBefore(const QueryHit& a, const QueryHit& b) const override {
    if (a.along != b.along) return a.along < b.along;
    return a.body != b.body ? a.body < b.body : a.shape < b.shape;
  }

  bool isBoxWithin(ProxyId proxy, double distance) const override {
    return meet({local_.from, local_.to, local_.radius + distance}, boxOf(proxy)).has_value();
  }
  bool isShapeWithin(ProxyId proxy, double distance, const NarrowPhase& exact) const override {
    const double limit = segment_.radius + slack_ + distance;
    return isWithin(axis(exact).measure(snapshot, proxy, limit), limit);
  }
  bool isCellWithin(const PlacedMap& map, double distance) const override {
    return firstAlong(map, *map.cells.grid, inMap(map, segment_.radius + distance)).has_value();
  }
  bool isTouchedBy(const Sphere& sphere) const override;
  bool isFreeIn(const PlacedMap& map, const UnmappedSpace& unmapped) const override;

 private:
  Probe axis(const NarrowPhase& narrow_phase) const {
    if (!axis_) axis_ = length_ > 0.0 ? narrow_phase.needle(length_) : narrow_phase.point();
    return {narrow_phase, *axis_, world_from_axis_};
  }
  Segment inMap(const PlacedMap& map, double radius) const {
    return {map.map_from_world * segment_.from, map.map_from_world * segment_.to, radius};
  }
  /// Returns the voxel that a segment in the frame of a map touches first. Counts the rounding errors of inMap().
  std::optional<VoxelTouch> firstAlong(const PlacedMap& map, const StaticGrid& cells, const Segment& in_map) const {
    const double size = segment_.from.norm() + length_ + map.world_from_map.translation().norm();
    return cells.firstAlong(in_map, gapRounding(size));
  }
  double firstTouch(ProxyId proxy, const NarrowPhase& exact, Proximity& found) const;

  const Segment segment_;  // in the world frame
  const Segment local_;    // the same segment, relative to the origin of the snapshot
  const double length_;    // [m] length of the segment
  const double slack_;     // [m] rounding error of a distance
  const Pose world_from_axis_;
  mutable std::shared_ptr<const Solid> axis_;  // created by the first call of axis()
};

bool SegmentQuestion::gather(std::size_t round, std::vector<QueryHit>&, std::vector<ProxyId>& candidates) {
  if (round > 0) return false;
  std::vector<SegmentHit> hits;
  snapshot.broadPhase().along(local_, hits);
  candidates.clear();
  for (const SegmentHit& hit : hits) candidates.push_back(hit.id);
  return true;
}

bool SegmentQuestion::hitsBox(ProxyId proxy, QueryHit& hit) const {
  const auto meeting = meet(local_, boxOf(proxy));
  if (!meeting) return false;  // the grid stores the box grown by its margin, so not every candidate is a hit
  hit.along = meeting->along;
  hit.center_distance = meeting->axis_distance;
  setDistance(hit, meeting->axis_distance > 0.0 ? meeting->axis_distance - segment_.radius : QueryHit::kUnknown);
  hit.point = meeting->point + origin();
  return true;
}

/// Returns how far [m] a sphere moves along the segment before it first touches a shape. The sphere advances in steps.
/// Each step is as long as the sphere surely moves without a touch (conservative advancement; after Mirtich 1996,
/// section 2.3).
/// @param found  receives the proximity of the sphere's center and the shape at the first touch
double SegmentQuestion::firstTouch(ProxyId proxy, const NarrowPhase& exact, Proximity& found) const {
  const Eigen::Vector3d step = segment_.to - segment_.from;
  double along = 0.0;
  for (int count = 0; count < kMostSteps; ++count) {
    const Eigen::Vector3d at = length_ > 0.0 ? Eigen::Vector3d(segment_.from + along / length_ * step) : segment_.from;
    const Probe center{exact, *exact.point(), Pose(Eigen::Translation3d(at))};
    found = center.measure(snapshot, proxy, kInfinity);
    const double left = found.distance - segment_.radius;
    if (!(left > slack_) || along >= length_) break;
    along = std::min(along + left, length_);
  }
  return along;
}

bool SegmentQuestion::hitsShape(ProxyId proxy, const NarrowPhase& exact, QueryHit& hit) const {
  Proximity found = axis(exact).measure(snapshot, proxy, segment_.radius + slack_);
  if (found.status == Measure::not_measured) return true;
  if (!(found.distance <= segment_.radius + slack_)) return false;
  describe(hit, found);
  hit.center_distance = found.distance;
  setDistance(hit, signedDistanceOf(found) - segment_.radius);
  if (found.status == Measure::failed) return true;
  hit.along = firstTouch(proxy, exact, found);
  if (found.on_second.allFinite()) {
    hit.point = found.on_second;
    hit.normal = -found.normal;
  }
  return true;
}

bool SegmentQuestion::hitsMap(const PlacedMap& map, QueryHit& hit) const {
  const Segment in_map = inMap(map, segment_.radius);
  const auto first = firstAlong(map, *map.cells.grid, in_map);
  if (!first) return false;
  const Eigen::Vector3d step = in_map.to - in_map.from;
  const Eigen::Vector3d at = in_map.from + (length_ > 0.0 ? first->along / length_ : 0.0) * step;
  const Eigen::AlignedBox3d cube = map.cubeOf(first->voxel);
  hit = map.hitOf(first->voxel, at, (nearestPoint(cube, at) - at).norm(), isExact());
  hit.along = first->along;
  const double gap = hit.center_distance - segment_.radius;  // at the first touch; other points may be nearer
  setDistance(hit, gap > 0.0 ? gap : QueryHit::kUnknown);
  if (isExact() && (segment_.radius == 0.0 || hit.normal.hasNaN())) {
    hit.normal = map.world_from_map.linear() * normalWhereEntered(cube, at, step);
  }
  return true;
}

/// The signed distance from the plane changes linearly along the segment.
bool SegmentQuestion::hitsPlane(const PlacedPlane& plane, QueryHit& hit) const {
  const double from = plane.signedDistanceOf(local_.from), to = plane.signedDistanceOf(local_.to);
  const double least = std::min(from, to);
  if (!(least <= segment_.radius + slack_)) return false;
  const double fraction = from > segment_.radius ? std::min(1.0, (from - segment_.radius) / (from - to)) : 0.0;
  hit = plane.hitOf(local_.from + fraction * (local_.to - local_.from), origin(), isExact());
  hit.along = fraction * length_;
  hit.center_distance = std::max(0.0, least);
  if (isExact()) hit.status = least > 0.0 ? Measure::apart : Measure::contact;
  setDistance(hit, least - segment_.radius);
  return true;
}

bool SegmentQuestion::isTouchedBy(const Sphere& sphere) const {
  const Eigen::Vector3d step = segment_.to - segment_.from, to_center = sphere.center - segment_.from;
  const double square = step.squaredNorm();
  const double fraction = square > 0.0 ? std::clamp(to_center.dot(step) / square, 0.0, 1.0) : 0.0;
  const double limit = segment_.radius + sphere.radius;
  return (to_center - fraction * step).norm() <= limit + touchSlack(sphere.center, limit);
}

bool SegmentQuestion::isFreeIn(const PlacedMap& map, const UnmappedSpace& unmapped) const {
  const Segment capsule = inMap(map, segment_.radius + map.reach + touchSlack(segment_.from, segment_.radius));
  const auto speaksOf = [&](const Eigen::Vector3d& end) {
    return unmapped.extent.contains(grown(Eigen::AlignedBox3d(end), capsule.radius));
  };
  return speaksOf(capsule.from) && speaksOf(capsule.to) && !firstAlong(map, unmapped.cells, capsule);
}

}  // namespace

QueryAnswer query(const Snapshot& snapshot, const Segment& segment, const QueryScope& scope) {
  const DefaultFloatEnvironment environment;
  checkQueryPoint(segment.from, "the segment's start");
  checkQueryPoint(segment.to, "the segment's end");
  checkQueryLength(segment.radius, "the query's radius");
  SegmentQuestion question(snapshot, scope, segment);
  return answerTo(question);
}

}  // namespace hgrid
