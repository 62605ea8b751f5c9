// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#include "map_measurement.h"

#include <array>
#include <chrono>
#include <stdexcept>
#include <string>
#include <thread>

#include "map_stream.h"
#include "question_stream.h"
#include "running_node.h"

namespace hgrid {
namespace bench {
namespace {

using Clock = std::chrono::steady_clock;

constexpr char kTopic[] = "/bench_map";
constexpr int kTurns = 4;          // number of turns with each kind of map
constexpr double kMapsPerS = 1.0;  // [1/s] how often the map is replaced

struct Seen {
  Sightings ticks;
  RoundTrips questions;
};

void sleepUntil(Clock::time_point begin, double seconds) {
  std::this_thread::sleep_until(begin +
                                std::chrono::duration_cast<Clock::duration>(std::chrono::duration<double>(seconds)));
}

/// Watches the node for `duration` [s]. Sends the maps in the middle of each second, so that the node has time to read
/// the last map before the next turn. `maps` is null if the map must not change.
void turn(double duration, MapStream* maps, RunningNode& node, QuestionStream& questions, Seen& seen) {
  const Clock::time_point begin = Clock::now();
  node.watch(seen.ticks);
  questions.noteIn(&seen.questions);
  for (double due = 0.5 / kMapsPerS; due < duration; due += 1.0 / kMapsPerS) {
    sleepUntil(begin, due);
    if (maps != nullptr) maps->publishNext();
  }
  sleepUntil(begin, duration);
  questions.noteIn(nullptr);
  node.rest();
}

Measurement measurementOf(const Workload& workload, const Seen& seen, double maps_per_s) {
  Measurement measurement = measurementOf(workload, seen.ticks);
  measurement.maps_per_s = maps_per_s;
  measurement.parts.push_back({"query_sphere", spreadOf(seen.questions.sphere)});
  measurement.parts.push_back({"query_segment", spreadOf(seen.questions.segment)});
  return measurement;
}

}  // namespace

MapMeasurement measureMaps(double duration) {
  const Workload workload = robotsInBuilding(4, 20, 100.0, kTopic);
  MapStream maps(kTopic);
  RunningNode node(workload, duration);
  QuestionStream questions(node.name());
  std::array<Seen, 2> seen;
  for (int i = 0; i < kTurns; ++i) {
    turn(duration, nullptr, node, questions, seen[0]);
    turn(duration, &maps, node, questions, seen[1]);
  }
  if (questions.failures() > 0) {
    throw std::runtime_error(std::to_string(questions.failures()) + " queries were not answered");
  }
  if (questions.replacements() + 1 != maps.published()) {
    throw std::runtime_error("of " + std::to_string(maps.published() - 1) + " maps that were sent, " +
                             std::to_string(questions.replacements()) + " were used by the node");
  }
  return {measurementOf(workload, seen[0], 0.0), measurementOf(workload, seen[1], kMapsPerS),
          seen[1].questions.sphere.size() + seen[1].questions.segment.size(), maps.messageBytes()};
}

}  // namespace bench
}  // namespace hgrid
