// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

#include <cmath>

#include "src/node/time/clock_watch.h"

namespace hgrid {
namespace test {

/// A time or a duration of so many seconds.
inline Time s(double seconds) { return Time(std::llround(1e9 * seconds)); }

/// The moment when the clocks show so many seconds.
inline Moment moment(double ros, double steady) {
  Moment result;
  result.ros = s(ros);
  result.steady = std::chrono::steady_clock::time_point(s(steady));
  return result;
}

}  // namespace test
}  // namespace hgrid
