// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

#include <cstddef>
#include <map>
#include <string>
#include <vector>

namespace hgrid {
namespace bench {

/// What was seen of a node while it was watched, in one span of time or in several.
struct Sightings {
  std::map<std::string, std::vector<double>> seconds;  ///< [s] of each tick, by the node's own names; "latency"
  std::size_t pairs = 0, ticks = 0, late_cycles = 0;   ///< late_cycles: of /tf
  double duration = 0.0;                               ///< [s] that it was watched
  double node_time = 0.0, bench_time = 0.0;            ///< [s] of processor that the two processes used meanwhile
  double others_time = 0.0;                            ///< [s] the same of all other programs
};

}  // namespace bench
}  // namespace hgrid
