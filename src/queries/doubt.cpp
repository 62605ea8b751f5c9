// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
//
// Whether a query that found nothing may answer CLEAR. It may not while something that it asks about can be in its
// region unseen:
//  - a body that a gap of a source hides,
//  - a body without a pose, or whose shapes were not all read,
//  - a body that may have moved since its pose was last known,
//  - what fills space that no map knows to be free.
#include "hgrid_proximity/queries/query.h"
#include "hgrid_proximity/refusal.h"
#include "queries/question.h"
#include "world/body_gap.h"
#include "world/pair_margin.h"

namespace hgrid {
namespace {

/// Whether nothing bounds where the body can be, or how far it extends.
bool canBeAnywhere(const Body& body, const BodyPose& pose) {
  if (!body.covered && !body.waived) return true;
  // FROZEN: the clock does not say how old the pose is. INVALID: newer data was refused, or publishers contradict it.
  if (pose.state == Freshness::frozen || pose.state == Freshness::invalid) return true;
  if (body.kind == BodyKind::cloud && pose.state >= Freshness::lost) return true;  // its cells are gone
  return pose.state == Freshness::unplaced || !(pose.reach <= kQueryReach);
}

std::string doubtOf(const Body& body, const BodyPose& pose) {
  const std::string gap = gapLeftBy(body, pose);
  if (canBeAnywhere(body, pose) && !gap.empty()) return gap;
  return (gap.empty()
              ? std::string(name(pose.state)) + " " + body.name + ": its pose is " + secondsText(pose.age) + " old"
              : gap) +
         ", so it may have moved here since";
}

void note(QueryAnswer& answer, Unknown because, std::string reason) {
  answer.because = because;
  answer.reason = std::move(reason);
}

/// [m] By how much two bodies may be nearer than their poses say. Links of one robot whose poses have the same age have
/// not moved relative to each other.
double reachBetween(const Snapshot& snapshot, std::uint32_t first, std::uint32_t second) {
  const BodyPose &a = snapshot.poses()[first], &b = snapshot.poses()[second];
  return movedTogether(snapshot.structure(), first, a.cohort, second, b.cohort) ? 0.0 : a.reach + b.reach;
}

/// Whether a body that has a pose may be in the region by now, given its own movement and that of the asking body.
bool mayBeInRegion(const Question& question, std::uint32_t body) {
  const Snapshot& snapshot = question.snapshot;
  const Structure& structure = snapshot.structure();
  const NarrowPhase* exact = question.scope.exact;
  const std::uint32_t asking = question.askingBody();
  const double reach = asking == Structure::kNone ? snapshot.poses()[body].reach : reachBetween(snapshot, asking, body);
  if (!(reach > 0.0)) return false;
  if (!(reach <= kQueryReach)) return true;
  for (ProxyId proxy = structure.first_proxy[body]; proxy < structure.first_proxy[body + 1]; ++proxy) {
    if (question.time.isOver(TimeBudget::Step::slow)) return false;
    if (!question.isBoxWithin(proxy, reach)) continue;
    if (exact == nullptr || question.isShapeWithin(proxy, reach, *exact)) return true;
  }
  if (!structure.isMap(body)) return false;
  bool met = false;
  forEachMap(snapshot, question.scope, [&](const PlacedMap& map) {
    if (met || map.body != body || question.time.isOver(TimeBudget::Step::slow)) return;
    met = question.isCellWithin(map, reach);
  });
  return met;
}

/// Notes why the answer is not CLEAR because of a gap of a source. @returns whether there is such a reason
bool noteGap(const Question& question, QueryAnswer& answer) {
  for (const SourceGap& gap : question.snapshot.gaps()) {
    if (!inScope(question.snapshot, question.scope, gap)) continue;
    if (gap.within && !question.isTouchedBy(*gap.within)) continue;
    note(answer, Unknown::incomplete, "'" + gap.source + "' is not complete: " + gap.sentence);
    return true;
  }
  return false;
}

/// Notes why the answer is not CLEAR because of one body. @returns whether there is such a reason
bool noteBody(const Question& question, std::uint32_t body, QueryAnswer& answer) {
  const Snapshot& snapshot = question.snapshot;
  if (question.time.isOver(TimeBudget::Step::fast)) return false;
  if (body == question.askingBody() || !inScope(snapshot, question.scope, body)) return false;
  const Body& what = snapshot.structure().bodies[body];
  const BodyPose& pose = snapshot.poses()[body];
  if (canBeAnywhere(what, pose)) {
    if (snapshot.hasGap(what.name)) return false;  // noteGap() has looked where the body can be
    note(answer, pose.state < Freshness::lost && what.covered ? Unknown::stale_body : Unknown::incomplete,
         doubtOf(what, pose));
    return true;
  }
  if (!mayBeInRegion(question, body)) return false;
  const std::uint32_t mover = pose.reach > 0.0 ? body : question.askingBody();
  note(answer, Unknown::stale_body, doubtOf(snapshot.structure().bodies[mover], snapshot.poses()[mover]));
  return true;
}

/// Notes why the answer is not CLEAR because of any body. @returns whether there is such a reason
bool noteBodies(const Question& question, QueryAnswer& answer) {
  const Snapshot& snapshot = question.snapshot;
  const std::uint32_t asking = question.askingBody();
  if (asking != Structure::kNone) {
    const Body& body = snapshot.structure().bodies[asking];
    const BodyPose& pose = snapshot.poses()[asking];
    if (canBeAnywhere(body, pose)) {
      note(answer, Unknown::incomplete, doubtOf(body, pose));
      return true;
    }
    if (pose.reach > 0.0) {  // then every other body may be nearer than the poses say
      for (std::uint32_t other = 0; other < snapshot.poses().size(); ++other) {
        if (noteBody(question, other, answer)) return true;
      }
    }
  }
  for (const std::uint32_t body : snapshot.doubtful()) {
    if (noteBody(question, body, answer)) return true;
  }
  return false;
}

/// Whether the query asks about maps. One that leaves out all maps does not need them to know its region.
bool asksMaps(const Snapshot& snapshot, const QueryScope& scope) {
  bool has_maps = false;
  for (const std::uint32_t map : snapshot.structure().maps) {
    if (snapshot.structure().bodies[map].kind == BodyKind::cloud) continue;
    if (inScope(snapshot, scope, map)) return true;
    has_maps = true;
  }
  return !has_maps && scope.include.empty();
}

/// Notes that the answer is not CLEAR because of space that is not known to be free. @returns whether it is so. One map
/// must know all of the region: what several maps know only together counts as unknown.
bool noteUnmapped(const Question& question, QueryAnswer& answer) {
  const Snapshot& snapshot = question.snapshot;
  if (!snapshot.reportsUnmapped() || !asksMaps(snapshot, question.scope)) return false;
  bool known = false;
  forEachMap(snapshot, question.scope, [&](const PlacedMap& map) {
    if (known || !map.cells.unmapped || question.time.isOver(TimeBudget::Step::slow)) return;
    known = question.isFreeIn(map, *map.cells.unmapped);
  });
  if (known || question.time.wasOver()) return false;
  note(answer, Unknown::unmapped, "it passes through space that no map knows to be free");
  return true;
}

}  // namespace

void noteDoubt(const Question& question, QueryAnswer& answer) {
  if (noteGap(question, answer) || noteBodies(question, answer)) return;
  noteUnmapped(question, answer);
}

}  // namespace hgrid
