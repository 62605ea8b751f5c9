// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
//
// Whether a query that found nothing may answer CLEAR. It may not while something that it asks about can be in its
// region unseen: a source with a gap, a body that was never placed or not wholly read, a body that may have moved
// since its pose was last known, or space that no map knows.
#include "hgrid_proximity/bodies/name.h"
#include "hgrid_proximity/refusal.h"
#include "queries/region.h"
#include "world/body_gap.h"
#include "world/pair_margin.h"

namespace hgrid {
namespace {

/// Whether nothing bounds where the body can be, or how far it extends.
bool canBeAnywhere(const Body& body, const BodyPose& pose) {
  if (!body.covered && !body.waived) return true;
  // FROZEN: the clock does not say how old the pose is. INVALID: newer data was refused, or publishers contradict it.
  if (pose.state == Freshness::frozen || pose.state == Freshness::invalid) return true;
  if (isCloud(body) && pose.state >= Freshness::lost) return true;  // its cells are gone
  return pose.state == Freshness::unplaced || !(pose.reach <= Snapshot::kQueryReach);
}

std::string doubtOf(const Body& body, const BodyPose& pose) {
  const std::string gap = gapLeftBy(body, pose);
  if (canBeAnywhere(body, pose) && !gap.empty()) return gap;
  return (gap.empty()
              ? std::string(name(pose.state)) + " " + body.name + ": its pose is " + secondsText(pose.age) + " old"
              : gap) +
         ", so it may have moved here since";
}

}  // namespace

bool Snapshot::inScope(const QueryScope& scope, const SourceGap& gap) const {
  const auto included = [&](const std::string& glob) { return canMatchTogether(glob, gap.bodies); };
  const auto excluded = [&](const std::string& glob) { return coversGlob(glob, gap.bodies); };
  return (scope.include.empty() || std::any_of(scope.include.begin(), scope.include.end(), included)) &&
         std::none_of(scope.exclude.begin(), scope.exclude.end(), excluded);
}

bool Snapshot::hasGap(const std::string& body) const {
  return std::any_of(gaps_.begin(), gaps_.end(), [&](const SourceGap& gap) { return gap.bodies == body; });
}

/// [m] By how much two bodies may be nearer than their poses say. Links of one robot that are equally old have not
/// moved against each other.
double Snapshot::reachBetween(std::uint32_t first, std::uint32_t second) const {
  if (movedTogether(*structure_, first, poses_[first].cohort, second, poses_[second].cohort)) return 0.0;
  return poses_[first].reach + poses_[second].reach;
}

/// Whether a body that has a pose may be in the region by now, as far as its own movement and that of the body that
/// asks go.
bool Snapshot::mayMeet(std::uint32_t body, const QueryScope& scope, const Region& region) const {
  const std::uint32_t asking = region.askingBody();
  const double reach = asking == Structure::kNone ? poses_[body].reach : reachBetween(asking, body);
  if (!(reach > 0.0)) return false;
  if (!(reach <= kQueryReach)) return true;
  for (ProxyId proxy = structure_->first_proxy[body]; proxy < structure_->first_proxy[body + 1]; ++proxy) {
    if (!region.meets(proxy, reach)) continue;
    if (scope.exact == nullptr || region.meetsShape(proxy, reach, *scope.exact)) return true;
  }
  if (!structure_->isMap(body)) return false;
  bool met = false;
  forEachMap(scope, [&](const PlacedMap& map) { met = met || (map.body == body && region.meets(map, reach)); });
  return met;
}

/// Notes in the answer why it cannot be CLEAR because of one body. @returns whether there is such a reason
bool Snapshot::doubtBody(std::uint32_t body, const QueryScope& scope, const Region& region, QueryAnswer& answer) const {
  if (body == region.askingBody() || !inScope(scope, body)) return false;
  const Body& what = structure_->bodies[body];
  const BodyPose& pose = poses_[body];
  if (canBeAnywhere(what, pose)) {
    if (hasGap(what.name)) return false;  // the gap knows better where the body can be
    answer.because = pose.state < Freshness::lost && what.covered ? Unknown::stale_body : Unknown::incomplete;
    answer.reason = doubtOf(what, pose);
    return true;
  }
  if (!mayMeet(body, scope, region)) return false;
  const bool own = pose.reach > 0.0;  // otherwise the body that asks has moved
  const std::uint32_t mover = own ? body : region.askingBody();
  answer.because = Unknown::stale_body;
  answer.reason = doubtOf(structure_->bodies[mover], poses_[mover]);
  return true;
}

void Snapshot::doubt(const QueryScope& scope, const Region& region, QueryAnswer& answer) const {
  for (const SourceGap& gap : gaps_) {
    if (!inScope(scope, gap) || (gap.within && !region.meets(*gap.within))) continue;
    answer.because = Unknown::incomplete;
    answer.reason = "'" + gap.source + "' is not complete: " + gap.sentence;
    return;
  }
  const std::uint32_t asking = region.askingBody();
  if (asking != Structure::kNone && canBeAnywhere(structure_->bodies[asking], poses_[asking])) {
    answer.because = Unknown::incomplete;
    answer.reason = doubtOf(structure_->bodies[asking], poses_[asking]);
    return;
  }
  if (asking != Structure::kNone && poses_[asking].reach > 0.0) {  // then every other body may be nearer than it was
    for (std::uint32_t body = 0; body < poses_.size(); ++body) {
      if (doubtBody(body, scope, region, answer)) return;
    }
  }
  for (const std::uint32_t body : doubtful_) {
    if (doubtBody(body, scope, region, answer)) return;
  }
  if (!region.isUnmapped(scope)) return;
  answer.because = Unknown::unmapped;
  answer.reason = "it passes through space that no map knows to be free";
}

}  // namespace hgrid
