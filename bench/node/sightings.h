// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

#include <cstddef>
#include <map>
#include <string>
#include <vector>

namespace hgrid {
namespace bench {

/// Data collected about a node while it was watched, in one or several spans of time.
struct Sightings {
  /// [s] timings of each tick by name. "latency" is measured by the benchmark; the node's own timing of this name is
  /// "after data".
  std::map<std::string, std::vector<double>> seconds;
  std::size_t pairs = 0, ticks = 0, late_cycles = 0;  ///< late_cycles: cycles of /tf that began late
  double duration = 0.0;                              ///< [s] how long the node was watched
  double node_time = 0.0, bench_time = 0.0;           ///< [s] processor time of the node and of this process
  double others_time = 0.0;                           ///< [s] processor time of all other programs
};

}  // namespace bench
}  // namespace hgrid
