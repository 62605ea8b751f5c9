// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#include <algorithm>
#include <cmath>
#include <limits>

#include "hgrid_proximity/geometry/float_environment.h"
#include "hgrid_proximity/refusal.h"
#include "queries/region.h"

namespace hgrid {
namespace {

constexpr int kMostSteps = 500;  // towards the first touch; each at least halves what a straight approach leaves

/// The pose of a needle along a segment.
Pose alongSegment(const Segment& segment) {
  Pose pose = Pose::Identity();
  const Eigen::Vector3d way = segment.to - segment.from;
  pose.translation() = segment.from + 0.5 * way;
  pose.linear() = Eigen::Quaterniond::FromTwoVectors(Eigen::Vector3d::UnitZ(), way).toRotationMatrix();
  return pose;
}

/// How far along a segment a ball that moves along it first touches what `distanceTo` measures: steps as long as
/// nothing can be in the way (conservative advancement; after Mirtich 1996, section 2.3). What was found there is left
/// in `found`.
template <class DistanceTo>
double firstTouch(const Segment& segment, const DistanceTo& distanceTo, Proximity& found) {
  const Eigen::Vector3d way = segment.to - segment.from;
  const double length = way.norm();
  const double slack = touchSlack(segment.from, segment.radius + length);
  double along = 0.0;
  for (int step = 0; step < kMostSteps; ++step) {
    const Eigen::Vector3d at = length > 0.0 ? Eigen::Vector3d(segment.from + along / length * way) : segment.from;
    found = distanceTo(at);
    const double left = found.distance - segment.radius;
    if (!(left > slack) || along >= length) break;
    along = std::min(along + left, length);
  }
  return along;
}

void describe(QueryHit& hit, const Proximity& found) {
  hit.status = found.status;
  hit.point = found.on_second;
  hit.normal = -found.normal;
}

}  // namespace

void checkQueryPoint(const Eigen::Vector3d& point, const std::string& what) {
  if (!point.allFinite()) throw Refusal(Code::nonfinite, what + " is not finite; every coordinate must be");
  checkWithin(point, Snapshot::kQueryReach, what);
}

void checkQueryLength(double length, const std::string& what) {
  if (!std::isfinite(length) || length < 0.0) {
    throw Refusal(Code::bad_geometry, what + " is " + text(length) + " m; it must be finite and not negative");
  }
  if (length > Snapshot::kQueryReach) {
    throw Refusal(Code::out_of_range,
                  what + " is " + text(length) + " m; it must be at most " + text(Snapshot::kQueryReach) + " m");
  }
}

QueryAnswer Snapshot::query(const Sphere& sphere, const QueryScope& scope) const {
  const DefaultFloatEnvironment environment;
  checkQueryPoint(sphere.center, "the query's centre");
  checkQueryLength(sphere.radius, "the query's radius");
  const Sphere local{sphere.center - origin_, sphere.radius};
  std::vector<ProxyId> candidates;
  broad_phase_->overlapping(local, candidates);
  std::vector<QueryHit> hits;
  for (const ProxyId proxy : candidates) {
    const std::uint32_t body = structure_->body_of_proxy[proxy];
    if (!inScope(scope, body)) continue;
    const Aabb& box = boxes_[proxy];
    if (!touches(local, box)) continue;  // the grid holds it wider, by its margin
    QueryHit hit;
    hit.body = body;
    hit.shape = proxy - structure_->first_proxy[body];
    hit.center_distance = distance(box, local.center);
    hit.point = nearestPoint(box, local.center) + origin_;
    if (scope.exact != nullptr) {
      const Probe probe{*scope.exact, scope.exact->point(), Pose(Eigen::Translation3d(sphere.center))};
      const double radius = sphere.radius + touchSlack(sphere.center, sphere.radius);
      const Proximity found = probe.measure(*this, body, hit.shape, radius);
      if (found.status != Measure::not_measured) {
        if (!(found.distance <= radius)) continue;
        hit.center_distance = found.distance;
        describe(hit, found);
      }
    }
    hit.distance = std::max(0.0, hit.center_distance - sphere.radius);
    hits.push_back(hit);
  }
  addMaps(sphere, scope, hits);
  return finished(hits, scope, false, SphereRegion(*this, sphere));
}

QueryAnswer Snapshot::query(const Segment& segment, const QueryScope& scope) const {
  const DefaultFloatEnvironment environment;
  checkQueryPoint(segment.from, "the segment's start");
  checkQueryPoint(segment.to, "the segment's end");
  checkQueryLength(segment.radius, "the query's radius");
  const Segment local{segment.from - origin_, segment.to - origin_, segment.radius};
  const double length = (segment.to - segment.from).norm();
  const Pose core_pose = length > 0.0 ? alongSegment(segment) : Pose(Eigen::Translation3d(segment.from));
  const auto core = [&](const NarrowPhase& narrow_phase) {
    return Probe{narrow_phase, length > 0.0 ? narrow_phase.needle(length) : narrow_phase.point(), core_pose};
  };
  std::vector<SegmentHit> candidates;
  broad_phase_->along(local, candidates);
  std::vector<QueryHit> hits;
  for (const SegmentHit& candidate : candidates) {
    const std::uint32_t body = structure_->body_of_proxy[candidate.id];
    if (!inScope(scope, body)) continue;
    const Aabb& box = boxes_[candidate.id];
    const auto meeting = meet(local, box);
    if (!meeting) continue;  // the grid holds it wider, by its margin
    QueryHit hit;
    hit.body = body;
    hit.shape = candidate.id - structure_->first_proxy[body];
    hit.center_distance = meeting->axis_distance;
    hit.along = meeting->along;
    hit.point = meeting->point + origin_;
    if (scope.exact != nullptr) {
      const double radius = segment.radius + touchSlack(segment.from, segment.radius + length);
      Proximity found = core(*scope.exact).measure(*this, body, hit.shape, radius);
      if (found.status != Measure::not_measured) {
        if (!(found.distance <= radius)) continue;
        hit.center_distance = found.distance;
        describe(hit, found);
        if (found.status != Measure::failed) {
          const double infinity = std::numeric_limits<double>::infinity();
          hit.along = firstTouch(
              segment,
              [&](const Eigen::Vector3d& at) {
                const Probe ball{*scope.exact, scope.exact->point(), Pose(Eigen::Translation3d(at))};
                return ball.measure(*this, body, hit.shape, infinity);
              },
              found);
          if (found.on_second.allFinite()) {
            hit.point = found.on_second;
            hit.normal = -found.normal;
          }
        }
      }
    }
    hit.distance = std::max(0.0, hit.center_distance - segment.radius);
    hits.push_back(hit);
  }
  addMaps(segment, scope, hits);
  return finished(hits, scope, true, SegmentRegion(*this, segment, core_pose));
}

QueryAnswer Snapshot::query(const QueryBox& box, const NarrowPhase& narrow_phase, const QueryScope& scope) const {
  const DefaultFloatEnvironment environment;
  const Eigen::Vector3d center = box.world_from_box.translation();
  checkQueryPoint(center, "the query's centre");
  for (int axis = 0; axis < 3; ++axis) checkQueryLength(box.size[axis], "a side of the query's box");
  const Probe probe{narrow_phase, narrow_phase.block(box.size), box.world_from_box};
  const Probe middle{narrow_phase, narrow_phase.point(), Pose(Eigen::Translation3d(center))};
  const double slack = touchSlack(center, box.size.norm()), infinity = std::numeric_limits<double>::infinity();
  const Eigen::Vector3d half = box.world_from_box.linear().cwiseAbs() * (0.5 * box.size);
  const Eigen::Vector3d reach = half.array() + 2.0 * slack;
  Aabb around;
  for (int axis = 0; axis < 3; ++axis) {
    around.min[axis] = roundedDown(center[axis] - origin_[axis] - reach[axis]);
    around.max[axis] = roundedUp(center[axis] - origin_[axis] + reach[axis]);
  }
  std::vector<ProxyId> candidates;
  broad_phase_->overlapping(around, candidates);
  std::vector<QueryHit> hits;
  for (const ProxyId proxy : candidates) {
    const std::uint32_t body = structure_->body_of_proxy[proxy];
    if (!inScope(scope, body)) continue;
    const Aabb& target = boxes_[proxy];
    const Eigen::Vector3d low = target.min.cast<double>(), high = target.max.cast<double>();
    const Pose world_from_target(Eigen::Translation3d(origin_ + 0.5 * (low + high)));
    Proximity found = narrow_phase.measure({*probe.core, probe.world_from_core, 0.0},
                                           {*narrow_phase.block(high - low), world_from_target, 0.0}, slack);
    if (!(found.distance <= slack)) continue;
    QueryHit hit;
    hit.body = body;
    hit.shape = proxy - structure_->first_proxy[body];
    hit.center_distance = distance(target, center - origin_);
    hit.point = nearestPoint(target, center - origin_) + origin_;
    if (scope.exact != nullptr) {
      found = probe.measure(*this, body, hit.shape, slack);
      if (found.status != Measure::not_measured) {
        if (!(found.distance <= slack)) continue;
        const Proximity from_middle = middle.measure(*this, body, hit.shape, infinity);
        describe(hit, from_middle);
        hit.status = found.status;
        hit.center_distance = from_middle.distance;
      }
    }
    hits.push_back(hit);
  }
  addMaps(box, narrow_phase, scope, hits);
  return finished(hits, scope, false, BoxRegion(*this, box, narrow_phase));
}

}  // namespace hgrid
