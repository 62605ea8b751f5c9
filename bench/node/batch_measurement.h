// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

#include <cstddef>
#include <string>
#include <vector>

namespace hgrid {
namespace bench {

/// Times of a request with many questions, and of the library for the same questions about an equal world. The time of
/// a request is from the call of the service to its return.
struct BatchMeasurement {
  std::string title;          ///< the service and the world
  std::size_t questions = 0;  ///< number of questions in a request
  std::size_t hits = 0;       ///< number of answers with the verdict HIT
  double service_ms = 0.0;    ///< [ms] median
  double library_ms = 0.0;    ///< [ms] median
  double ratio = 0.0;         ///< median of the ratios of successive turns
};

/// Measures ~check_states with 1,000 states of a Panda among 1,000 boxes, and ~query_batch with 10,000 spheres among
/// 10,000 boxes. The connections are persistent. Service and library answer in turn, for `duration` [s] and at least 10
/// times each. If the robot descriptions are not found (see realRobots()), ~check_states is left out.
/// @throws std::runtime_error if the node does not answer, or if a verdict differs from that of the library
std::vector<BatchMeasurement> measureBatches(double duration);

}  // namespace bench
}  // namespace hgrid
