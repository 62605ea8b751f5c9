// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
//
// Decides whether a query that hit nothing may answer CLEAR. The query must answer UNKNOWN if one of these, in the
// scope of the query, can be in its region unseen:
//  - a body that its source does not know yet (SourceGap),
//  - a body without a pose, or with shapes that could not be read,
//  - a body that may have moved since its last known pose,
//  - anything in space that no map knows to be free.
//
// The region of a query is the part of space in which a body would be a hit.
#include "hgrid_proximity/queries/query.h"
#include "queries/doubtful_body.h"
#include "queries/question.h"

namespace hgrid {
namespace {

void note(QueryAnswer& answer, Unknown because, std::string reason) {
  answer.because = because;
  answer.reason = std::move(reason);
}

/// Returns whether a body may have come into the region since its pose, because it moved or the asking body moved.
bool mayBeInRegion(const Question& question, std::uint32_t body) {
  const Snapshot& snapshot = question.snapshot;
  const Structure& structure = snapshot.structure();
  const NarrowPhase* exact = question.scope.exact;
  const std::uint32_t asking = question.askingBody();
  const double reach = asking == Structure::kNone ? snapshot.poses()[body].reach : snapshot.reachBetween(asking, body);
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

/// If missing data of a source (SourceGap) prevents CLEAR, sets the reason in `answer` and returns true.
bool noteGap(const Question& question, QueryAnswer& answer) {
  for (const SourceGap& gap : question.snapshot.gaps()) {
    if (!inScope(question.snapshot, question.scope, gap)) continue;
    if (gap.within && !question.isTouchedBy(*gap.within)) continue;
    note(answer, Unknown::incomplete, "source '" + gap.source + "' is not complete: " + gap.sentence);
    return true;
  }
  return false;
}

/// If this body prevents CLEAR, sets the reason in `answer` and returns true.
bool noteBody(const Question& question, std::uint32_t body, QueryAnswer& answer) {
  const Snapshot& snapshot = question.snapshot;
  if (question.time.isOver(TimeBudget::Step::fast)) return false;
  if (body == question.askingBody() || !inScope(snapshot, question.scope, body)) return false;
  const Body& what = snapshot.structure().bodies[body];
  const BodyPose& pose = snapshot.poses()[body];
  if (canBeAnywhere(what, pose)) {
    if (snapshot.hasGap(what.name)) return false;  // noteGap() has already checked where the body can be
    note(answer, pose.state < Freshness::lost && what.covered ? Unknown::stale_body : Unknown::incomplete,
         doubtOf(what, pose));
    return true;
  }
  if (!mayBeInRegion(question, body)) return false;
  const std::uint32_t mover = pose.reach > 0.0 ? body : question.askingBody();
  note(answer, Unknown::stale_body, doubtOf(snapshot.structure().bodies[mover], snapshot.poses()[mover]));
  return true;
}

/// If any body prevents CLEAR, sets the reason in `answer` and returns true.
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
    if (pose.reach > 0.0) {  // the asking body may have moved, so every other body may be nearer now
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

/// If the region is not known to be free, sets the reason in `answer` and returns true. A single map must know the
/// whole region: a region that only several maps together know to be free counts as unknown.
bool noteUnmapped(const Question& question, QueryAnswer& answer) {
  const Snapshot& snapshot = question.snapshot;
  if (!snapshot.reportsUnmapped() || !asksMaps(snapshot, question.scope)) return false;
  bool known = false;
  forEachMap(snapshot, question.scope, [&](const PlacedMap& map) {
    if (known || !map.cells.unmapped || question.time.isOver(TimeBudget::Step::slow)) return;
    known = question.isFreeIn(map, *map.cells.unmapped);
  });
  if (known || question.time.wasOver()) return false;
  note(answer, Unknown::unmapped, "the region of the query contains space that no map knows to be free");
  return true;
}

}  // namespace

void noteDoubt(const Question& question, QueryAnswer& answer) {
  if (noteGap(question, answer) || noteBodies(question, answer)) return;
  noteUnmapped(question, answer);
}

}  // namespace hgrid
