// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

#include "node/time/clock_watch.h"

namespace hgrid {

/// The clock that measures the age of poses.
///
/// Normally it is the steady clock, so that setting the wall clock changes no age. If /clock drives ROS time, it
/// advances with ROS time instead. While ROS time stands still or runs back, it advances with the steady clock. A
/// reading is never smaller than an earlier one. Only differences between readings have a meaning.
class AgeClock {
 public:
  /// @param simulated  whether /clock drives ROS time
  explicit AgeClock(bool simulated) : simulated_(simulated) {}

  /// Advances the clock to the moment `now`. Each tick calls this before it reads the clock.
  /// @param frozen  whether ROS time has stood still for so long that this clock follows the steady clock
  void look(const Moment& now, bool frozen);
  /// Returns the reading at a moment. The moment must not be before the last look().
  Time read(const Moment& moment) const;

 private:
  bool simulated_;
  bool frozen_ = false;
  Time reading_{0};                                   // reading at the last look()
  Moment last_;                                       // moment of the last look()
  std::chrono::steady_clock::time_point advanced_{};  // when look() last noticed that ROS time had changed
};

}  // namespace hgrid
