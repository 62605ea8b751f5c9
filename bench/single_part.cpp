// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#include <cstdio>
#include <memory>

#include "bench/measure/match.h"
#include "bench/parts.h"
#include "bench/singles/singles_play.h"
#include "bench/workload/workloads.h"
#include "bench/workload/world.h"

namespace hgrid {
namespace bench {
namespace {

constexpr std::size_t kSteps = 21000;  // 1,000 judged and 20,000 timed

void play(const std::string& workload, StepKind kind, const SingleSteps& steps, const Options& options,
          std::vector<Record>& records) {
  Match match;
  const Sample expected = expectedOf(steps);
  match.decide(0, expected.count, expected.checksum);
  std::vector<SinglePeerKind> kinds;
  for (const SinglePeerKind& peer : singlePeers()) {
    if (!options.peer(peer.name)) continue;
    kinds.push_back(peer);
    const auto begin = [&steps, peer, kind]() -> Contestant::Play {
      const auto play = std::make_shared<SinglesPlay>(peer.make(), kind, steps);
      return [play](double budget_ms) { return (*play)(budget_ms); };
    };
    match.add(std::make_unique<Contestant>(begin, 1), false, false);
  }
  match.play(options.quick ? 3 : 5, options.quick ? 40.0 : 150.0, options.quick ? 20.0 : 60.0);

  const std::size_t n = steps.start.size();
  std::printf("\n%s, n = %zu, %s: %.3g hits each\n", workload.c_str(), n, name(kind),
              double(expected.count) / double(SinglesPlay::kJudged));
  const std::vector<Score> scores = match.scores();
  for (std::size_t i = 0; i < kinds.size(); ++i) {
    const std::string& status = match.contestant(i).status();
    const double us = scores[i].median_ms;  // of 1,000 steps
    records.push_back(Record("single")
                          .text("peer", kinds[i].name)
                          .text("step", name(kind))
                          .text("workload", workload)
                          .number("n", double(n))
                          .number("median_us", us)
                          .number("min_us", scores[i].min_ms)
                          .number("spread", scores[i].spread)
                          .flag("correct", scores[i].correct && status == "ok")
                          .text("status", status));
    std::printf("  %-28s %10.4f us  spread %3.0f %%  %s\n", kinds[i].name.c_str(), us, 100.0 * scores[i].spread,
                remarkOn(scores[i], status));
  }
  std::fflush(stdout);
}

}  // namespace

void runSingle(const Options& options, std::vector<Record>& records) {
  std::vector<std::size_t> sizes = options.sizes;
  if (sizes.empty()) sizes = {1000, 10000, 100000};
  for (const std::string& workload : options.boxWorkloads({"uniform", "mixed", "robots", "heaps64"})) {
    for (const std::size_t n : sizes) {
      const SingleSteps steps(World(workload, n, 1.0).boxes(), kSteps);
      for (const StepKind kind : kStepKinds) play(workload, kind, steps, options, records);
    }
  }
}

}  // namespace bench
}  // namespace hgrid
