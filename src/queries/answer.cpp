// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#include <algorithm>

#include "queries/question.h"

namespace hgrid {
namespace {

/// Appends a hit for each shape of a body that the question hits.
void findBodies(Question& question, std::vector<QueryHit>& hits) {
  const Structure& structure = question.snapshot.structure();
  const QueryScope& scope = question.scope;
  const TimeBudget::Step step = scope.exact == nullptr ? TimeBudget::Step::fast : TimeBudget::Step::slow;
  std::vector<ProxyId> candidates;
  for (std::size_t round = 0; question.gather(round, hits, candidates); ++round) {
    for (const ProxyId proxy : candidates) {
      if (question.time.isOver(step)) return;
      QueryHit hit;
      hit.body = structure.body_of_proxy[proxy];
      hit.shape = structure.shapeOf(proxy);
      if (!inScope(question.snapshot, scope, hit.body) || !question.hitsBox(proxy, hit)) continue;
      if (scope.exact != nullptr && !question.hitsShape(proxy, *scope.exact, hit)) continue;
      hits.push_back(hit);
    }
  }
}

/// Appends a hit for each map whose cells the question hits.
void findCells(const Question& question, std::vector<QueryHit>& hits) {
  forEachMap(question.snapshot, question.scope, [&](const PlacedMap& map) {
    if (question.time.isOver(TimeBudget::Step::slow)) return;
    QueryHit hit;
    if (question.hitsMap(map, hit)) hits.push_back(hit);
  });
}

/// Appends a hit for each plane that the question hits. The broad phase does not hold planes, and there are only a few.
void findPlanes(const Question& question, std::vector<QueryHit>& hits) {
  const auto step = question.scope.exact == nullptr ? TimeBudget::Step::fast : TimeBudget::Step::slow;
  forEachPlane(question.snapshot, question.scope, [&](const PlacedPlane& plane) {
    if (question.time.isOver(step)) return;
    QueryHit hit;
    if (question.hitsPlane(plane, hit)) hits.push_back(hit);
  });
}

}  // namespace

bool Question::goesBefore(const QueryHit& a, const QueryHit& b) const {
  if (a.distance != b.distance) return a.distance < b.distance;
  if (a.center_distance != b.center_distance) return a.center_distance < b.center_distance;
  return a.body != b.body ? a.body < b.body : a.shape < b.shape;
}

void sortOnePerBody(const Question& question, std::vector<QueryHit>& hits) {
  const auto in_order = [&](const QueryHit& a, const QueryHit& b) { return question.goesBefore(a, b); };
  std::sort(hits.begin(), hits.end(), [&](const QueryHit& a, const QueryHit& b) {
    return a.body != b.body ? a.body < b.body : question.goesBefore(a, b);
  });
  const auto same_body = [](const QueryHit& a, const QueryHit& b) { return a.body == b.body; };
  hits.erase(std::unique(hits.begin(), hits.end(), same_body), hits.end());
  std::sort(hits.begin(), hits.end(), in_order);
}

QueryAnswer answerTo(Question& question) {
  checkScope(question.snapshot, question.scope);
  QueryAnswer answer;
  std::vector<QueryHit>& hits = answer.hits;
  findBodies(question, hits);
  findPlanes(question, hits);
  findCells(question, hits);
  sortOnePerBody(question, hits);
  const std::size_t wanted = question.wanted(), limit = question.scope.limit;
  if (wanted > 0 && hits.size() > wanted) hits.resize(wanted);
  answer.total = hits.size();
  if (limit > 0 && hits.size() > limit) hits.resize(limit);
  if (answer.total == 0 && !question.time.wasOver()) noteDoubt(question, answer);
  answer.examined_all = !question.time.wasOver();
  if (answer.total == 0 && answer.because == Unknown::no && !answer.examined_all) {
    answer.because = Unknown::budget;
    answer.reason = "the deadline of the query passed before it had examined everything";
  }
  if (answer.total > 0) {
    answer.verdict = Verdict::hit;
  } else if (answer.because == Unknown::no) {
    answer.verdict = Verdict::clear;
  }
  return answer;
}

}  // namespace hgrid
