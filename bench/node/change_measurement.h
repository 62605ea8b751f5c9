// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

#include <cstddef>
#include <vector>

namespace hgrid {
namespace bench {

/// Durations of ticks without a change and of ticks that add obstacles.
struct ChangeMeasurement {
  std::size_t bodies = 0;           ///< number of bodies at first, of which 100 move
  double resting_ms = 0.0;          ///< [ms] median duration of a tick without a change
  double longest_resting_ms = 0.0;  ///< [ms] duration of the longest tick without a change
  /// Requests with the same number of added obstacles.
  struct Row {
    std::size_t added = 0;         ///< number of obstacles that each request added
    std::size_t requests = 0;      ///< number of requests
    double longest_tick_ms = 0.0;  ///< [ms] longest tick of the 5 s that contain the requests
    double answer_ms = 0.0;        ///< [ms] median time from a request to its answer
  };
  std::vector<Row> rows;
};

/// Measures how long ticks take while obstacles are added to a world of 10,000 bodies, first one by one, then many in
/// one request.
/// @throws std::runtime_error if the node does not answer
ChangeMeasurement measureChanges();

}  // namespace bench
}  // namespace hgrid
