// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#include <cstdio>

#include "bench/measure/match.h"
#include "bench/measure/median.h"
#include "bench/measure/turns.h"
#include "bench/parts.h"
#include "bench/queries/queries_play.h"
#include "bench/workload/workloads.h"

namespace hgrid {
namespace bench {
namespace {

/// The workload and the kind of queries of one match.
struct Setting {
  std::string workload;
  Placed placed;
  QueryKind kind;
};

std::vector<const QueryPeerKind*> peersFor(const std::vector<QueryPeerKind>& kinds, const Options& options,
                                           QueryKind kind) {
  std::vector<const QueryPeerKind*> peers;
  for (const QueryPeerKind& peer : kinds) {
    if (options.peer(peer.name) && peer.make()->answers(kind)) peers.push_back(&peer);
  }
  return peers;
}

Record recordOf(const Setting& setting, std::size_t n, const QueryPeerKind& peer) {
  Record record("query");
  record.text("peer", peer.name).text("query", name(setting.kind));
  return record.text("workload", setting.workload).text("placed", name(setting.placed)).number("n", double(n));
}

void play(const std::vector<QueryPeerKind>& kinds, const Options& options, const Setting& setting, const World& world,
          const QuerySet& queries, std::vector<Record>& records) {
  const QueryKind kind = setting.kind;
  const Judge judge(kind, queries, world.boxes());
  const std::vector<const QueryPeerKind*> peers = peersFor(kinds, options, kind);
  Match match;
  match.decide(0, judge.count(), judge.checksum());
  for (const QueryPeerKind* const peer : peers) {
    const auto begin = [&, peer]() -> Contestant::Play {
      const auto play = std::make_shared<QueriesPlay>(*peer, kind, world.boxes(), queries, judge);
      return [play](double budget_ms) { return (*play)(budget_ms); };
    };
    match.add(std::make_unique<Contestant>(begin, 1), false, false);
  }
  const int rounds = options.quick || !isEven(setting.workload) ? 3 : 5;
  match.play(rounds, options.quick ? 20.0 : 100.0, options.quick ? 20.0 : 60.0);

  std::printf("\n%s, n = %zu, %s %s: %zu of %zu queries judged, %.3g hits each\n", setting.workload.c_str(),
              world.boxes().size(), name(kind), name(setting.placed), judge.judgedCount(), judge.size(),
              double(judge.count()) / double(judge.judgedCount()));
  const std::vector<Score> scores = match.scores();
  for (std::size_t i = 0; i < peers.size(); ++i) {
    const Score& score = scores[i];
    const std::string& status = match.contestant(i).status();
    const double us = 1e3 * score.median_ms / double(QueriesPlay::kChunk);
    Record record = recordOf(setting, world.boxes().size(), *peers[i]);
    record.number("median_us", us);
    record.number("min_us", 1e3 * score.min_ms / double(QueriesPlay::kChunk)).number("spread", score.spread);
    record.number("hits_per_query", double(score.count) / double(judge.judgedCount()));
    record.bits("checksum", score.checksum).flag("correct", score.correct && status == "ok");
    record.number("judged", double(judge.judgedCount())).text("status", status);
    records.push_back(record);
    std::printf("  %-28s %10.4f us  spread %3.0f %%  %s\n", peers[i]->name.c_str(), us, 100.0 * score.spread,
                remarkOn(score, status));
  }
  std::fflush(stdout);
}

/// Measures how long each peer takes to prepare for queries.
void prepare(const std::vector<QueryPeerKind>& kinds, const Options& options, const std::string& workload,
             const World& world, std::vector<Record>& records) {
  constexpr std::size_t kTurns = 3;
  std::vector<std::vector<double>> ms(kinds.size());
  for (std::size_t turn = 0; turn < kTurns; ++turn) {
    for (std::size_t i = 0; i < kinds.size(); ++i) {
      if (!options.peer(kinds[i].name)) continue;
      const std::unique_ptr<QueryPeer> peer = kinds[i].make();
      const Clock::time_point begin = Clock::now();
      peer->load(world.boxes());
      ms[i].push_back(msSince(begin));
    }
  }
  std::printf("\n%s, n = %zu: preparation for queries, median of %zu\n", workload.c_str(), world.boxes().size(),
              kTurns);
  for (std::size_t i = 0; i < kinds.size(); ++i) {
    if (ms[i].empty()) continue;
    Record record("preparation");
    record.text("peer", kinds[i].name).text("workload", workload).number("n", double(world.boxes().size()));
    record.number("median_ms", medianOf(ms[i])).flag("correct", true).text("status", "ok");
    records.push_back(record);
    std::printf("  %-28s %10.4f ms\n", kinds[i].name.c_str(), medianOf(ms[i]));
  }
}

}  // namespace

void runQueriesOf(const std::vector<QueryPeerKind>& kinds, std::size_t n, const Options& options,
                  std::vector<Record>& records) {
  std::vector<std::string> usual = evenWorkloads();
  if (options.quick) {
    usual.push_back("fleet");
  } else {
    usual.insert(usual.end(), unevenWorkloads().begin(), unevenWorkloads().end());
  }
  for (const std::string& workload : options.boxWorkloads(usual)) {
    const World world(workload, n, 1.0);
    prepare(kinds, options, workload, world, records);
    const QuerySet anywhere = queriesAnywhere(world, options.questions);
    for (const QueryKind kind : {QueryKind::sphere, QueryKind::segment, QueryKind::box})
      play(kinds, options, {workload, Placed::anywhere, kind}, world, anywhere, records);
    if (!isEven(workload)) continue;
    const QuerySet near = queriesNear(workload, world, options.questions);
    for (const QueryKind kind : kQueryKinds) play(kinds, options, {workload, Placed::near, kind}, world, near, records);
  }
}

void runQueries(const Options& options, std::vector<Record>& records) {
  std::size_t n = options.quick ? 10000 : 100000;
  if (options.sizes.size() == 1) n = options.sizes.front();
  runQueriesOf(queryPeers(), n, options, records);
}

}  // namespace bench
}  // namespace hgrid
