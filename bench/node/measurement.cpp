// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#include "measurement.h"

#include <algorithm>
#include <chrono>
#include <thread>
#include <utility>

#include "running_node.h"

namespace hgrid {
namespace bench {
namespace {

/// The rows of the table: the name of the row, and the name of the timing in the ~status of the node.
const std::vector<std::pair<const char*, const char*>> kParts = {
    {"tick", "tick"},
    {"poses", "tick.poses"},
    {"boxes", "tick.boxes"},
    {"broad phase", "tick.grid"},
    {"pairs", "tick.pairs"},
    {"publish", "tick.publish"},
    {"distances", "distances"},
    {"tf", "tf"},
    {"after data", "after data"},
    {"latency", "latency"},
};

}  // namespace

Spread spreadOf(std::vector<double> seconds) {
  if (seconds.empty()) return {};
  std::sort(seconds.begin(), seconds.end());
  return {1e3 * seconds[seconds.size() / 2], 1e3 * seconds[seconds.size() * 99 / 100]};
}

Measurement measurementOf(const Workload& workload, const Sightings& seen) {
  Measurement measurement;
  measurement.title = workload.title;
  measurement.bodies = workload.bodies;
  measurement.rate = workload.rate;
  measurement.distances = workload.distances;
  for (const auto& part : kParts) {
    const auto found = seen.seconds.find(part.second);
    if (found != seen.seconds.end()) measurement.parts.push_back({part.first, spreadOf(found->second)});
  }
  measurement.cpu_percent = 100.0 * seen.node_time / seen.duration;
  measurement.bench_percent = 100.0 * seen.bench_time / seen.duration;
  measurement.others_percent = 100.0 * seen.others_time / seen.duration;
  if (seen.ticks > 0) measurement.pairs = static_cast<double>(seen.pairs) / static_cast<double>(seen.ticks);
  measurement.ticks = seen.ticks;
  measurement.late_cycles = seen.late_cycles;
  return measurement;
}

Measurement measure(const Workload& workload, double duration) {
  RunningNode node(workload, duration);
  Sightings seen;
  node.watch(seen);
  std::this_thread::sleep_for(std::chrono::duration<double>(duration));
  node.rest();
  return measurementOf(workload, seen);
}

}  // namespace bench
}  // namespace hgrid
