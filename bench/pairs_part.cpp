// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#include <algorithm>
#include <cstdio>
#include <numeric>
#include <stdexcept>

#include "bench/measure/loading_play.h"
#include "bench/measure/match.h"
#include "bench/measure/pairs_play.h"
#include "bench/pairs_settings.h"
#include "bench/parts.h"
#include "bench/peers/factories.h"
#include "bench/peers/hgrid_peer.h"
#include "bench/workload/real_worlds.h"
#include "bench/workload/workloads.h"
#include "hgrid_proximity/broadphase/hgrid.h"

namespace hgrid {
namespace bench {
namespace {

/// A peer with its settings. Each run is one line of the table that a match prints.
struct Run {
  std::string peer, instructions;
  int threads;
  std::uint64_t age;
  std::function<std::unique_ptr<Peer>()> make;
  bool loads = false;  ///< true: loading and the first frame are measured; false: frames
};

Run hgridRun(int threads, const std::string& instructions, std::uint64_t age = 0) {
  return {"hgrid", instructions, threads, age, [=] { return makeHGrid(threads, instructions); }};
}

Run runOf(const PeerKind& kind, std::uint64_t age = 0) { return {kind.name, kind.instructions, 1, age, kind.make}; }

/// Returns HGrid with its default settings. If all boxes of an even world move, adds runs with the other instruction
/// sets. For 10,000 boxes or more, also adds a run with two threads.
std::vector<Run> hgridRuns(const Setting& setting) {
  const std::vector<std::string> all = hgridInstructions();
  std::vector<Run> runs{hgridRun(1, all.back())};
  if (setting.moving < 1.0 || !isEven(setting.workload)) return runs;
  for (std::size_t i = 0; i + 1 < all.size(); ++i) runs.push_back(hgridRun(1, all[i]));
  if (setting.n >= 10000) runs.push_back(hgridRun(2, all.back()));
  return runs;
}

std::vector<Run> runsOf(const Options& options, const Setting& setting) {
  std::vector<Run> runs;
  if (options.peer("hgrid")) runs = hgridRuns(setting);
  // In an uneven world, a frame may take ten times as long. Therefore a quick run leaves out slow peers earlier.
  const std::size_t n = options.quick && !isEven(setting.workload) ? 10 * setting.n : setting.n;
  for (const PeerKind& kind : peers()) {
    const std::size_t most = options.quick ? kind.quick_most : kind.most;
    if (options.peer(kind.name) && most >= n) runs.push_back(runOf(kind));
  }
  if (setting.workload == "uniform" && setting.moving == 1.0 && options.peer("floor"))
    runs.push_back({"floor", "default", 1, 0, makeFloor});
  return runs;
}

Record recordOf(const Setting& setting, const Run& run, const Score& score, const std::string& status) {
  Record record(run.loads ? "loading" : run.age > 0 ? "ageing" : setting.kind);
  record.text("peer", run.peer).text("workload", setting.workload).number("n", double(setting.n));
  record.number("moving", setting.moving)
      .text("movers", name(setting.movers))
      .number("threads", run.threads)
      .text("isa", run.instructions);
  if (run.age > 0) record.number("age", double(run.age));
  record.number("median_ms", score.median_ms).number("min_ms", score.min_ms).number("spread", score.spread);
  record.number("frames", double(score.timed)).number("pairs", double(score.count)).bits("checksum", score.checksum);
  record.number("pairs_per_box", double(score.count) / double(setting.n));
  record.flag("correct", score.correct && status == "ok");
  if (!run.loads) record.number("bytes_per_object", score.bytes / double(setting.n));
  record.text("status", status);
  return record;
}

void print(const Setting& setting, const Run& run, const Score& score, const std::string& status) {
  char memory[32] = "";
  if (!run.loads) std::snprintf(memory, sizeof memory, "%7.1f B", score.bytes / double(setting.n));
  std::printf(
      "  %-28s %-8s threads %d  age %-5llu %10.4f ms  min %10.4f  spread %3.0f %%  %9s  %8llu pairs, %.3g per box  "
      "%s\n",
      run.peer.c_str(), run.instructions.c_str(), run.threads, static_cast<unsigned long long>(run.age),
      score.median_ms, score.min_ms, 100.0 * score.spread, memory, static_cast<unsigned long long>(score.count),
      double(score.count) / double(setting.n), run.peer == "floor" && status == "ok" ? "" : remarkOn(score, status));
}

/// Number of untimed frames at the beginning if different boxes move in each frame. A peer that keeps data from frame
/// to frame needs some frames until its frame time is steady.
constexpr std::uint64_t kSettled = 30;

std::unique_ptr<Contestant> contestantOf(const Run& run, const Setting& setting, World& world) {
  const std::uint64_t age = setting.movers == Movers::changing ? kSettled : run.age;
  const auto begin = [&world, run, age]() -> Contestant::Play {
    if (run.loads) return LoadingPlay(world, run.make);
    const auto play = std::make_shared<PairsPlay>(world, run.make, age);
    return [play](double budget_ms) { return (*play)(budget_ms); };
  };
  return std::make_unique<Contestant>(begin, run.threads);
}

/// Measures all runs in one world, prints the results, and appends them to `records`.
void play(const Options& options, const Setting& setting, World& world, const std::vector<Run>& runs,
          std::vector<Record>& records) {
  Match match;
  for (const Run& run : runs) {
    const bool votes = run.peer != "hgrid" && run.peer != "floor";
    match.add(contestantOf(run, setting, world), votes, run.peer == "brute force");
  }
  const bool even = isEven(setting.workload);
  const int rounds = options.quick || setting.n >= 1000000 || !even ? 3 : 5;
  const double usual_s = options.quick ? 20.0 : even ? 120.0 : 40.0;  // enough to load and run about four frames
  match.play(rounds, options.quick ? 40.0 : 150.0, options.limit > 0.0 ? options.limit : usual_s);

  const char* what = !runs.empty() && runs.front().loads  ? ", loading and first pairs"
                     : setting.movers == Movers::changing ? ", other boxes in each frame"
                                                          : "";
  std::printf("\n%s, n = %zu, %g %% move%s\n", setting.workload.c_str(), setting.n, 100.0 * setting.moving, what);
  const std::vector<Score> scores = match.scores();
  for (std::size_t i = 0; i < runs.size(); ++i) {
    const std::string& status = match.contestant(i).status();
    print(setting, runs[i], scores[i], status);
    if (runs[i].peer != "floor") {
      records.push_back(recordOf(setting, runs[i], scores[i], status));
      continue;
    }
    records.push_back(Record("floor").number("n", double(setting.n)).number("median_ms", scores[i].median_ms));
  }
  std::fflush(stdout);
}

void play(const Options& options, const Setting& setting, const std::vector<Run>& runs, std::vector<Record>& records) {
  World world(setting.workload, setting.n, setting.moving, setting.movers);
  play(options, setting, world, runs, records);
}

/// @throws std::runtime_error if HGrid does not find all pairs that must be found in this world.
void checkRequired(const RealWorld& real) {
  std::vector<ProxyId> ids(real.boxes.size());
  std::iota(ids.begin(), ids.end(), 0);
  HGrid grid(GridScale::fitting(real.boxes));
  grid.update(ids, real.boxes);
  std::vector<ProxyPair> pairs;
  grid.overlappingPairs(pairs);
  std::sort(pairs.begin(), pairs.end());
  for (const ProxyPair& pair : real.required) {
    if (!std::binary_search(pairs.begin(), pairs.end(), pair)) {
      throw std::runtime_error("hgrid misses the pair of " + std::to_string(pair.first) + " and " +
                               std::to_string(pair.second) + " in the world " + real.name);
    }
  }
}

}  // namespace

void runReal(const Options& options, std::vector<Record>& records) {
  if (options.worlds.empty()) return;
  for (const RealWorld& real : realWorlds(options.worlds)) {
    checkRequired(real);
    const Setting setting{real.name, real.boxes.size(), 1.0, Movers::same, "real"};
    World world(real.before, real.boxes);
    play(options, setting, world, runsOf(options, setting), records);
    std::printf("  hgrid finds all %zu pairs that must be found\n", real.required.size());
  }
}

void runPairsOf(const std::vector<PeerKind>& kinds, const Options& options, std::vector<Record>& records) {
  for (const Setting& setting : pairsSettings(options)) {
    std::vector<Run> runs;
    if (options.peer("hgrid")) runs.push_back(hgridRun(1, hgridInstructions().back()));
    for (const PeerKind& kind : kinds) {
      const std::size_t most = options.quick ? kind.quick_most : kind.most;
      if (options.peer(kind.name) && most >= setting.n) runs.push_back(runOf(kind));
    }
    play(options, setting, runs, records);
  }
}

void runPairs(const Options& options, std::vector<Record>& records) {
  for (const Setting& setting : pairsSettings(options)) play(options, setting, runsOf(options, setting), records);
}

void runLoadings(const Options& options, std::vector<Record>& records) {
  for (const Setting& setting : pairsSettings(options)) {
    if (setting.moving < 1.0 || setting.movers != Movers::same) continue;
    std::vector<Run> runs;
    for (Run& run : runsOf(options, setting)) {
      if (run.peer == "floor" || run.threads > 1) continue;
      if (run.peer == "hgrid" && run.instructions != hgridInstructions().back()) continue;
      runs.push_back(run);
      runs.back().loads = true;
    }
    play(options, setting, runs, records);
  }
}

void runAgeing(const Options& options, std::vector<Record>& records) {
  for (const std::string& workload : options.boxWorkloads(evenWorkloads())) {
    std::vector<Run> runs;
    for (const std::uint64_t age : {10, 300, 1500}) {
      runs.push_back(hgridRun(1, hgridInstructions().back(), age));
      for (const PeerKind& kind : peers()) {
        const bool old = age == 1500 || (age == 300 && workload != "uniform");
        const bool tree = kind.name == "FCL DynamicAABBTree" && !(options.quick && old);
        if (tree || kind.name == "brute force") runs.push_back(runOf(kind, age));
      }
    }
    play(options, {workload, 10000, 1.0, Movers::same}, runs, records);
  }
}

}  // namespace bench
}  // namespace hgrid
