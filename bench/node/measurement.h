// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "sightings.h"
#include "workload.h"

namespace hgrid {
namespace bench {

/// Median and 99th percentile of some values.
struct Spread {
  double median = 0.0, p99 = 0.0;
};

/// What was measured of a node that lived in a workload.
struct Measurement {
  struct Part {
    std::string name;
    Spread milliseconds;
  };
  std::string title;
  std::size_t bodies = 0;
  double rate = 0.0;                 ///< [Hz]
  bool distances = false;            ///< were measured
  std::optional<double> maps_per_s;  ///< [1/s] how often its map was replaced, where that was to be measured
  std::vector<Part> parts;           ///< of the ticks; "latency" after them
  double cpu_percent = 0.0;          ///< of one processor
  double bench_percent = 0.0;        ///< the same, of the process that moves the world, listens and asks
  double others_percent = 0.0;       ///< the same, of all others together: what they take disturbs the rest
  double pairs = 0.0;                ///< near pairs per tick, on average
  std::size_t ticks = 0;             ///< that were measured
  std::size_t late_cycles = 0;       ///< of /tf
};

Spread spreadOf(std::vector<double> seconds);
Measurement measurementOf(const Workload& workload, const Sightings& seen);

/// Starts a node, lets it run in the workload, and measures it for `duration` [s].
///
/// The parts are the node's own timings of every single tick (`last` of its ~status). "tf" is what it spent between
/// two ticks on transforms that it had received. Latency goes from the stamp of a cycle of /tf, taken just before it is
/// sent, to the reception of the first ~pairs that bears this stamp; it includes the wait for the next tick, and the
/// cycle is a little longer than a tick so that a run meets every phase between the two once.
///
/// @throws std::runtime_error if the node does not serve the whole world within a minute
Measurement measure(const Workload& workload, double duration);

}  // namespace bench
}  // namespace hgrid
