// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#include <algorithm>
#include <cmath>
#include <limits>
#include <map>

#include "hgrid_proximity/geometry/float_environment.h"
#include "hgrid_proximity/refusal.h"
#include "queries/region.h"

namespace hgrid {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr std::size_t kFirstLook = 16;  // boxes, beside four for each body that is wanted

/// [m] How far a hit may be; 0 stands for no limit.
double limitOf(double max_distance) { return max_distance > 0.0 ? max_distance : kInfinity; }

bool nearer(const QueryHit& a, const QueryHit& b) {
  return a.distance != b.distance ? a.distance < b.distance : a.shape < b.shape;
}

}  // namespace

/// Boxes come from the grid by growing distance, which is a lower bound of the one that is asked for; it is over when
/// no further box can be nearer than the last body that is wanted.
/// @param reach  [m] of what is asked from, around `center`
/// @param region  what lies within the limit
/// @param asked    a point or a body, from which maps are looked for
template <class Asked, class Ask>
QueryAnswer Snapshot::nearestBy(const Asked& asked, const Eigen::Vector3d& center, double reach, double max_distance,
                                const QueryScope& scope, const Region& region, const Ask& measure) const {
  const std::size_t wanted = std::max<std::uint32_t>(1, scope.limit);
  const double limit = limitOf(max_distance);
  std::map<std::uint32_t, QueryHit> best;  // by body
  std::vector<NearHit> near;
  for (std::size_t look = 4 * wanted + kFirstLook, done = 0;; look *= 4) {
    broad_phase_->nearest(center - origin_, look, limit + reach, near);
    for (; done < near.size(); ++done) {
      const ProxyId proxy = near[done].id;
      const std::uint32_t body = structure_->body_of_proxy[proxy];
      if (!inScope(scope, body)) continue;
      QueryHit hit;
      hit.body = body;
      hit.shape = proxy - structure_->first_proxy[body];
      if (!measure(proxy, limit, hit)) continue;
      const auto known = best.emplace(body, hit);
      if (!known.second && nearer(hit, known.first->second)) known.first->second = hit;
    }
    std::vector<double> distances;
    for (const auto& hit : best) distances.push_back(hit.second.distance);
    if (near.size() < look) break;  // there are no more
    if (distances.size() < wanted) continue;
    std::nth_element(distances.begin(), distances.begin() + static_cast<std::ptrdiff_t>(wanted - 1), distances.end());
    if (distances[wanted - 1] < near.back().distance - reach) break;
  }
  std::vector<QueryHit> hits;
  for (const auto& hit : best) hits.push_back(hit.second);
  addMapsNear(asked, limit, scope, hits);
  std::sort(hits.begin(), hits.end(), [](const QueryHit& a, const QueryHit& b) {
    return a.distance != b.distance ? a.distance < b.distance : a.body < b.body;
  });
  if (hits.size() > wanted) hits.resize(wanted);
  return finished(hits, scope, false, region);
}

QueryAnswer Snapshot::nearest(const Eigen::Vector3d& point, double max_distance, const QueryScope& scope) const {
  const DefaultFloatEnvironment environment;
  checkQueryPoint(point, "the query's point");
  checkQueryLength(max_distance, "max_distance");
  const auto measure = [&](ProxyId proxy, double up_to, QueryHit& hit) {
    hit.center_distance = hit.distance = distance(boxes_[proxy], point - origin_);
    hit.point = nearestPoint(boxes_[proxy], point - origin_) + origin_;
    if (hit.distance > up_to) return false;
    if (scope.exact == nullptr) return true;
    const Probe probe{*scope.exact, scope.exact->point(), Pose(Eigen::Translation3d(point))};
    const Proximity found = probe.measure(*this, hit.body, hit.shape, up_to);
    if (found.status == Measure::not_measured) return true;
    hit.status = found.status;
    hit.center_distance = hit.distance = found.distance;
    hit.point = found.on_second;
    hit.normal = -found.normal;
    return found.distance <= up_to;
  };
  return nearestBy(point, point, 0.0, max_distance, scope, SphereRegion(*this, {point, limitOf(max_distance)}),
                   measure);
}

QueryAnswer Snapshot::nearest(std::uint32_t from, double max_distance, const QueryScope& scope) const {
  const DefaultFloatEnvironment environment;
  checkQueryLength(max_distance, "max_distance");
  const Body& asking = structure_->bodies[from];
  if (poses_[from].state == Freshness::unplaced || asking.shapes.empty()) {
    throw Refusal(Code::not_ready, "body '" + asking.name + "' has no " + (asking.shapes.empty() ? "shapes" : "pose") +
                                       " to be near to");
  }
  const ProxyId first = structure_->first_proxy[from], last = structure_->first_proxy[from + 1];
  Eigen::Vector3d low = boxes_[first].min.cast<double>(), high = boxes_[first].max.cast<double>();
  for (ProxyId proxy = first; proxy < last; ++proxy) {
    low = low.cwiseMin(boxes_[proxy].min.cast<double>());
    high = high.cwiseMax(boxes_[proxy].max.cast<double>());
  }
  const Eigen::Vector3d center = origin_ + 0.5 * (low + high);
  return nearestBy(from, center, 0.5 * (high - low).norm(), max_distance, scope,
                   BodyRegion(*this, from, limitOf(max_distance)), [&](ProxyId proxy, double up_to, QueryHit& hit) {
                     if (hit.body == from) return false;
                     hit.distance = kInfinity;
                     for (ProxyId own = first; own < last; ++own) measureFrom(own, proxy, up_to, scope, hit);
                     hit.center_distance = hit.distance;
                     return hit.distance <= up_to;
                   });
}

/// From one shape of a body to one of another; the hit keeps the nearest.
void Snapshot::measureFrom(ProxyId own, ProxyId proxy, double up_to, const QueryScope& scope, QueryHit& hit) const {
  const double gap = distance(boxes_[own], boxes_[proxy]);
  if (gap > std::min(up_to, hit.distance)) return;
  const std::uint32_t from = structure_->body_of_proxy[own];
  const BodyShape& shape = structure_->bodies[from].shapes[own - structure_->first_proxy[from]];
  if (scope.exact != nullptr && shape.solid) {
    const Pose world_from_shape = poses_[from].world_from_body * shape.body_from_shape;
    const Probe probe{*scope.exact, shape.solid, world_from_shape, shape.padding};
    const Proximity found = probe.measure(*this, hit.body, hit.shape, std::min(up_to, hit.distance));
    if (found.status != Measure::not_measured) {
      if (!(found.distance < hit.distance)) return;
      hit.status = found.status;
      hit.distance = found.distance;
      hit.own_point = found.on_first;
      hit.point = found.on_second;
      hit.normal = -found.normal;
      return;
    }
  }
  if (!(gap < hit.distance)) return;
  hit.distance = gap;
  for (int axis = 0; axis < 3; ++axis) {  // nearest points of two boxes; in the middle of what they share
    const double low = std::max(boxes_[own].min[axis], boxes_[proxy].min[axis]),
                 high = std::min(boxes_[own].max[axis], boxes_[proxy].max[axis]);
    const bool own_first = boxes_[own].max[axis] < boxes_[proxy].min[axis];
    hit.own_point[axis] = origin_[axis] + (low <= high ? 0.5 * (low + high) : own_first ? high : low);
    hit.point[axis] = origin_[axis] + (low <= high ? 0.5 * (low + high) : own_first ? low : high);
  }
}

}  // namespace hgrid
