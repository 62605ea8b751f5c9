// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#include "bench/queries/queries_play.h"

#include "bench/measure/turns.h"

namespace hgrid {
namespace bench {

QueriesPlay::QueriesPlay(const QueryPeerKind& peer, QueryKind kind, const std::vector<Aabb>& boxes,
                         const QuerySet& queries, const Judge& judge)
    : peer_(peer.make()), kind_(kind), queries_(&queries), judge_(&judge) {
  peer_->load(boxes);
  result_ = judgedResult();
}

void QueriesPlay::answer(std::size_t query, std::vector<ProxyId>& found) {
  switch (kind_) {
    case QueryKind::sphere:
      return peer_->sphere(queries_->spheres[query], found);
    case QueryKind::segment:
      return peer_->segment(queries_->segments[query], found);
    case QueryKind::box:
      return peer_->box(queries_->boxes[query], found);
    case QueryKind::nearest:
    case QueryKind::nearest8:
      return peer_->nearest(queries_->spheres[query].center, countOf(kind_), found);
  }
}

Sample QueriesPlay::judgedResult() {
  Sample result;
  Checksum sum;
  for (std::size_t i = 0; i < judge_->size(); ++i) {
    if (!judge_->judges(i)) continue;
    answer(i, found_);
    result.count += found_.size();
    for (const ProxyId id : found_) sum.add(Judge::hit(i, id));
  }
  result.checksum = sum.value();
  return result;
}

double QueriesPlay::timedChunk() {
  const Clock::time_point begin = Clock::now();
  for (std::size_t i = 0; i < kChunk; ++i) answer(next_ + i, found_);
  next_ = (next_ + kChunk) % queries_->size();
  return msSince(begin);
}

std::vector<Sample> QueriesPlay::operator()(double budget_ms) {
  return samplesFor(budget_ms, result_, [this] { return timedChunk(); });
}

}  // namespace bench
}  // namespace hgrid
