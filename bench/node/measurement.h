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

/// Median and 99th percentile of a list of values.
struct Spread {
  double median = 0.0, p99 = 0.0;
};

/// The measured figures of a node that ran in a workload.
struct Measurement {
  /// One timed part of the tick, or another duration.
  struct Part {
    std::string name;
    Spread milliseconds;
  };
  std::string title;
  std::size_t bodies = 0;
  double rate = 0.0;                 ///< [Hz] rate of the messages on /tf, and of the ticks
  bool distances = false;            ///< whether the node measured distances
  std::optional<double> maps_per_s;  ///< [1/s] how often the map was replaced; empty if the world has no map
  std::vector<Part> parts;           ///< parts of the ticks, then "after data", then "latency"
  double cpu_percent = 0.0;          ///< processor time of the node, in percent of one processor
  double bench_percent = 0.0;        ///< processor time of this process, which moves the world and sends queries
  double others_percent = 0.0;       ///< processor time of all other processes, which disturb the measurement
  double pairs = 0.0;                ///< average number of near pairs per tick
  std::size_t ticks = 0;             ///< number of ticks that were measured
  std::size_t late_cycles = 0;       ///< number of cycles of /tf that began late
};

/// Returns the spread of durations [s] in milliseconds.
Spread spreadOf(std::vector<double> seconds);
/// Computes the figures of a node from the data that was collected while it was watched.
Measurement measurementOf(const Workload& workload, const Sightings& seen);

/// Starts a node, lets it run in the workload, and measures it for `duration` [s].
///
/// The parts of the tick are the node's own timings of each tick (`last` of its ~status). "tf" is the time that the
/// node spent on received transforms between two ticks. "after data" is its timing "latency": from the arrival of the
/// last transform that a tick needed until ~pairs was published. "latency" begins at the stamp of a cycle of /tf, which
/// is taken just before the cycle is sent. It ends when this process receives the first ~pairs with this stamp, so it
/// includes both ways through ROS.
///
/// @throws std::runtime_error if the node does not know the whole world within a minute
Measurement measure(const Workload& workload, double duration);

}  // namespace bench
}  // namespace hgrid
