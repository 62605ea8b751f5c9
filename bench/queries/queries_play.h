// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

#include "bench/measure/contestant.h"
#include "bench/queries/judge.h"

namespace hgrid {
namespace bench {

/// Measures how long a peer takes to answer queries of one kind.
///
/// First the peer answers the judged queries without timing. Then each sample times the next kChunk queries of the set.
class QueriesPlay {
 public:
  static constexpr std::size_t kChunk = 1000;

  QueriesPlay(const QueryPeerKind& peer, QueryKind kind, const std::vector<Aabb>& boxes, const QuerySet& queries,
              const Judge& judge);

  std::vector<Sample> operator()(double budget_ms);

 private:
  void answer(std::size_t query, std::vector<ProxyId>& found);
  Sample judgedResult();
  double timedChunk();

  std::unique_ptr<QueryPeer> peer_;
  QueryKind kind_;
  const QuerySet* queries_;
  const Judge* judge_;
  std::size_t next_ = 0;
  std::vector<ProxyId> found_;
  Sample result_;  // template of all samples; only their times differ
};

}  // namespace bench
}  // namespace hgrid
