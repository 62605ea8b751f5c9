// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

#include <cmath>

#include "src/node/time/clock_watch.h"

namespace hgrid {
namespace test {

/// Converts seconds into a time or a duration.
inline Time s(double seconds) { return Time(std::llround(1e9 * seconds)); }

/// Returns the moment at which the ROS clock and the steady clock show these times [s].
inline Moment moment(double ros, double steady) {
  Moment result;
  result.ros = s(ros);
  result.steady = std::chrono::steady_clock::time_point(s(steady));
  return result;
}

}  // namespace test
}  // namespace hgrid
