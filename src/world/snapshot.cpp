// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#include "hgrid_proximity/world/snapshot.h"

#include <algorithm>
#include <cmath>

#include "hgrid_proximity/bodies/name.h"
#include "hgrid_proximity/geometry/float_environment.h"
#include "hgrid_proximity/refusal.h"
#include "world/pair_margin.h"

namespace hgrid {
namespace {

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

double Snapshot::marginOf(std::uint32_t first, std::uint32_t second) const {
  return toldMargin(*structure_, first, second);
}

double Snapshot::growthOf(std::uint32_t first, std::uint32_t second) const {
  return widening(*structure_, first, stalenessOf(poses_[first]), second, stalenessOf(poses_[second]));
}

bool Snapshot::inScope(const QueryScope& scope, std::uint32_t body) const {
  const std::string& name = structure_->bodies[body].name;
  return (scope.include.empty() || matchesAny(scope.include, name)) && !matchesAny(scope.exclude, name);
}

QueryAnswer Snapshot::finished(std::vector<QueryHit>& hits, const QueryScope& scope, bool by_along,
                               const Region& region) const {
  sortOnePerBody(hits, by_along ? earlier : nearer);
  QueryAnswer answer;
  answer.total = hits.size();
  if (scope.limit > 0 && hits.size() > scope.limit) hits.resize(scope.limit);
  answer.hits = std::move(hits);
  if (answer.total == 0) doubt(scope, region, answer);
  if (answer.total > 0) {
    answer.verdict = Verdict::hit;
  } else if (answer.because == Unknown::no) {
    answer.verdict = Verdict::clear;
  }
  return answer;
}

double Snapshot::noContactBefore(std::uint32_t first, std::uint32_t second, double distance) const {
  double speed = 0.0, left = distance;
  for (const std::uint32_t i : {first, second}) {
    const Body& body = structure_->bodies[i];
    if (body.mobility == Mobility::fixed) continue;
    if (!std::isfinite(body.speed_bound)) return std::numeric_limits<double>::quiet_NaN();
    speed += body.speed_bound;
    left -= body.speed_bound * std::max(0.0, seconds(stamp_ - poses_[i].stamp));
  }
  left = std::max(0.0, left);
  if (left == 0.0) return 0.0;
  return speed > 0.0 ? left / speed : std::numeric_limits<double>::infinity();
}

}  // namespace hgrid
