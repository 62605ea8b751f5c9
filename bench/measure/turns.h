// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

#include <chrono>
#include <vector>

#include "bench/measure/sample.h"

namespace hgrid {
namespace bench {

using Clock = std::chrono::steady_clock;

inline double msSince(Clock::time_point begin) {
  return std::chrono::duration<double, std::milli>(Clock::now() - begin).count();
}

/// Calls `timed` at least once and until the time budget is used. `timed` returns the duration of a step [ms]. Returns
/// one copy of `result` for each call, with the duration of this call.
template <class Timed>
std::vector<Sample> samplesFor(double budget_ms, const Sample& result, Timed&& timed) {
  const Clock::time_point begin = Clock::now();
  std::vector<Sample> samples;
  while (samples.empty() || msSince(begin) < budget_ms) {
    samples.push_back(result);
    samples.back().ms = timed();
    samples.back().timed = 1;
  }
  return samples;
}

}  // namespace bench
}  // namespace hgrid
