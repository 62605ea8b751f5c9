// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

#include <algorithm>
#include <cmath>

#include "node/time/clock_watch.h"

namespace hgrid {

/// When data was measured, and when it arrived.
struct DataTime {
  Time stamp{0};         ///< [ROS time] when it was measured
  double latency = 0.0;  ///< [s] its age when it arrived
  std::chrono::steady_clock::time_point received{};

  DataTime() = default;
  /// Data with this stamp that arrived at the moment `arrival`.
  DataTime(Time measured, const Moment& arrival)
      : stamp(measured), latency(std::max(0.0, seconds(arrival.ros - measured))), received(arrival.steady) {}

  /// Returns the age of the data [s].
  /// @param simulated  whether /clock drives ROS time. If so, the age is measured in ROS time, otherwise by the steady
  /// clock.
  double age(const Moment& now, bool simulated) const {
    // If /clock went back, the stamp may lie in the future. That is as bad as a stamp that is just as far in the past.
    if (simulated) return std::abs(seconds(stamp - now.ros));
    return latency + std::chrono::duration<double>(now.steady - received).count();
  }
};

}  // namespace hgrid
