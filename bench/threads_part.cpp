// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#include <algorithm>
#include <chrono>
#include <cstdio>

#include "bench/measure/processors.h"
#include "bench/parts.h"
#include "bench/peers/hgrid_peer.h"
#include "bench/workload/workloads.h"
#include "bench/workload/world.h"

namespace hgrid {
namespace bench {
namespace {

using Clock = std::chrono::steady_clock;

constexpr double kFree = 1.9;  // both processors are considered free if two threads are this many times faster than one

double median(std::vector<double> values) {
  if (values.empty()) return 0.0;
  std::nth_element(values.begin(), values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2), values.end());
  return values[values.size() / 2];
}

/// HGrid with a fixed number of threads and its own copy of the world.
class Side {
 public:
  Side(const std::string& workload, std::size_t n, int threads)
      : world_(workload, n, 1.0), peer_(makeHGrid(threads, hgridInstructions().back())) {
    peer_->load(world_.boxes());
  }

  /// Runs `count` frames and returns their median time [ms].
  double frames(int count) {
    std::vector<double> times;
    for (int i = -2; i < count; ++i) {  // the first two frames fill the caches and are not timed
      world_.step();
      const Clock::time_point begin = Clock::now();
      peer_->frame(world_.frame(), pairs_);
      if (i >= 0) times.push_back(std::chrono::duration<double, std::milli>(Clock::now() - begin).count());
    }
    return median(times);
  }
  const std::vector<ProxyPair>& pairs() const { return pairs_; }

 private:
  World world_;
  std::unique_ptr<Peer> peer_;
  std::vector<ProxyPair> pairs_;
};

/// Measures one thread and two threads in turn. Ends after 12 turns in which both processors were free, or at the time
/// limit.
Record play(const std::string& workload, std::size_t n, bool quick) {
  Side one(workload, n, 1), two(workload, n, 2);
  const int frames = n >= 1000000 ? 4 : 10;
  const double limit_s = quick ? 2.0 : n >= 1000000 ? 25.0 : 15.0;
  const Clock::time_point begin = Clock::now();
  std::vector<double> processors, gains, free_gains;
  bool same = true;
  double before = gainOfTwoProcessors();
  while (free_gains.size() < 12 && std::chrono::duration<double>(Clock::now() - begin).count() < limit_s) {
    const double gain = one.frames(frames) / two.frames(frames);
    const double after = gainOfTwoProcessors();
    same = same && one.pairs() == two.pairs();
    processors.push_back(std::min(before, after));
    gains.push_back(gain);
    if (processors.back() >= kFree) free_gains.push_back(gain);
    before = after;
  }
  std::printf("  %-8s n = %-8zu gain %.2f, register loop %.2f; where that gains %.1f: %.2f (%zu of %zu turns)%s\n",
              workload.c_str(), n, median(gains), median(processors), kFree, median(free_gains), free_gains.size(),
              gains.size(), same ? "" : "  PAIRS DIFFER");
  std::fflush(stdout);
  Record record("threads");
  record.text("peer", "hgrid").text("workload", workload).number("n", double(n)).number("threads", 2);
  record.number("gain", median(gains)).number("gain_of_registers", median(processors));
  record.number("turns", double(gains.size())).number("free_turns", double(free_gains.size()));
  record.number("gain_in_free_turns", median(free_gains)).flag("same_bytes", same);
  return record;
}

}  // namespace

void runThreads(const Options& options, std::vector<Record>& records) {
  if (!options.peer("hgrid")) return;
  std::vector<std::size_t> sizes{100000, 1000000};
  if (options.quick) sizes.pop_back();
  if (!options.sizes.empty()) sizes = options.sizes;
  std::printf("\ntwo threads compared with one\n");
  for (const std::size_t n : sizes) {
    for (const std::string& workload : options.boxWorkloads(evenWorkloads()))
      records.push_back(play(workload, n, options.quick));
  }
}

}  // namespace bench
}  // namespace hgrid
