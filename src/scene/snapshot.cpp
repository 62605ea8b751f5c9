// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#include "hgrid_proximity/scene/snapshot.h"

#include <algorithm>
#include <cmath>

#include "hgrid_proximity/geometry/float_environment.h"
#include "hgrid_proximity/refusal.h"
#include "hgrid_proximity/scene/name.h"

namespace hgrid {
namespace {

void checkPoint(const Eigen::Vector3d& point, const std::string& what) {
  if (!point.allFinite()) throw Refusal(Code::nonfinite, what + " is not finite; every coordinate must be");
  checkWithin(point, Snapshot::kQueryReach, what);
}

void checkRadius(double radius) {
  if (!std::isfinite(radius) || radius < 0.0) {
    throw Refusal(Code::bad_geometry,
                  "the query's radius is " + text(radius) + " m; it must be finite and not negative");
  }
  if (radius > Snapshot::kQueryReach) {
    throw Refusal(Code::out_of_range, "the query's radius is " + text(radius) + " m; it must be at most " +
                                          text(Snapshot::kQueryReach) + " m");
  }
}

bool nearer(const QueryHit& a, const QueryHit& b) {
  if (a.distance != b.distance) return a.distance < b.distance;
  if (a.center_distance != b.center_distance) return a.center_distance < b.center_distance;
  return a.body != b.body ? a.body < b.body : a.shape < b.shape;
}

bool earlier(const QueryHit& a, const QueryHit& b) {
  if (a.along != b.along) return a.along < b.along;
  return a.body != b.body ? a.body < b.body : a.shape < b.shape;
}

/// Keeps of several hits on shapes of one body the first in `order`, then sorts by `order`.
void sortOnePerBody(std::vector<QueryHit>& hits, bool (*order)(const QueryHit&, const QueryHit&)) {
  std::sort(hits.begin(), hits.end(),
            [order](const QueryHit& a, const QueryHit& b) { return a.body != b.body ? a.body < b.body : order(a, b); });
  const auto same_body = [](const QueryHit& a, const QueryHit& b) { return a.body == b.body; };
  hits.erase(std::unique(hits.begin(), hits.end(), same_body), hits.end());
  std::sort(hits.begin(), hits.end(), order);
}

}  // namespace

std::uint32_t Structure::find(const std::string& name) const {
  const auto found = std::lower_bound(bodies.begin(), bodies.end(), name,
                                      [](const Body& body, const std::string& wanted) { return body.name < wanted; });
  const bool here = found != bodies.end() && found->name == name;
  return here ? static_cast<std::uint32_t>(found - bodies.begin()) : kNone;
}

bool Snapshot::inScope(const QueryScope& scope, std::uint32_t body) const {
  const std::string& name = structure_->bodies[body].name;
  return (scope.include.empty() || matchesAny(scope.include, name)) && !matchesAny(scope.exclude, name);
}

std::string Snapshot::doubtOf(std::uint32_t body) const {
  const BodyPose& pose = poses_[body];
  return std::string(name(pose.state)) + " " + structure_->bodies[body].name + ": its pose is " +
         secondsText(pose.age) + " old, it may have come here since";
}

QueryAnswer Snapshot::finished(std::vector<QueryHit>& hits, const QueryScope& scope, bool by_along,
                               const std::string& doubt) const {
  sortOnePerBody(hits, by_along ? earlier : nearer);
  QueryAnswer answer;
  answer.total = hits.size();
  if (scope.limit > 0 && hits.size() > scope.limit) hits.resize(scope.limit);
  answer.hits = std::move(hits);
  if (answer.total > 0) {
    answer.verdict = Verdict::hit;
  } else if (!complete()) {
    answer.because = Unknown::incomplete;
    answer.reason =
        "the world is not complete: " + (reasons_.empty() ? std::string("see the status") : reasons_.front());
  } else if (!doubt.empty()) {
    answer.because = Unknown::stale_body;
    answer.reason = doubt;
  } else {
    answer.verdict = Verdict::clear;
  }
  return answer;
}

QueryAnswer Snapshot::query(const Sphere& sphere, const QueryScope& scope) const {
  const DefaultFloatEnvironment environment;
  checkPoint(sphere.center, "the query's centre");
  checkRadius(sphere.radius);
  const Sphere local{sphere.center - origin_, sphere.radius};
  std::vector<ProxyId> candidates;
  grid_.overlapping(local, candidates);
  std::vector<QueryHit> hits;
  std::string doubt;
  for (const ProxyId proxy : candidates) {
    const std::uint32_t body = structure_->body_of_proxy[proxy];
    if (!inScope(scope, body)) continue;
    const Aabb& box = boxes_[proxy];
    if (touches(local, box)) {
      QueryHit hit;
      hit.body = body;
      hit.shape = proxy - structure_->first_proxy[body];
      hit.center_distance = distance(box, local.center);
      hit.distance = std::max(0.0, hit.center_distance - sphere.radius);
      hit.along = std::numeric_limits<double>::quiet_NaN();
      hit.point = nearestPoint(box, local.center) + origin_;
      hits.push_back(hit);
    } else if (poses_[body].growth > 0.0 && touches({local.center, local.radius + poses_[body].growth}, box)) {
      doubt = doubtOf(body);
    }
  }
  return finished(hits, scope, false, doubt);
}

QueryAnswer Snapshot::query(const Segment& segment, const QueryScope& scope) const {
  const DefaultFloatEnvironment environment;
  checkPoint(segment.from, "the segment's start");
  checkPoint(segment.to, "the segment's end");
  checkRadius(segment.radius);
  const Segment local{segment.from - origin_, segment.to - origin_, segment.radius};
  std::vector<SegmentHit> candidates;
  grid_.along(local, candidates);
  std::vector<QueryHit> hits;
  std::string doubt;
  for (const SegmentHit& candidate : candidates) {
    const std::uint32_t body = structure_->body_of_proxy[candidate.id];
    if (!inScope(scope, body)) continue;
    const Aabb& box = boxes_[candidate.id];
    if (const auto meeting = meet(local, box)) {
      QueryHit hit;
      hit.body = body;
      hit.shape = candidate.id - structure_->first_proxy[body];
      hit.center_distance = meeting->axis_distance;
      hit.distance = std::max(0.0, hit.center_distance - segment.radius);
      hit.along = meeting->along;
      hit.point = meeting->point + origin_;
      hits.push_back(hit);
    } else if (poses_[body].growth > 0.0 && meet({local.from, local.to, local.radius + poses_[body].growth}, box)) {
      doubt = doubtOf(body);
    }
  }
  return finished(hits, scope, true, doubt);
}

}  // namespace hgrid
