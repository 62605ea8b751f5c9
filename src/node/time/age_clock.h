// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

#include "node/time/clock_watch.h"

namespace hgrid {

/// The clock by which poses age.
///
/// It is the steady clock, so that setting the wall clock ages nothing. Under /clock it advances with ROS time instead;
/// while ROS time stands still or runs back, it advances with the steady clock. No reading is ever smaller than an
/// earlier one. Only differences of readings have a meaning.
class AgeClock {
 public:
  explicit AgeClock(bool simulated) : simulated_(simulated) {}

  /// Advances the clock to a moment. A tick calls this first.
  /// @param frozen  ROS time has stood still for so long that the clock advances with the steady clock
  void look(const Moment& now, bool frozen);
  /// The reading at a moment. The moment must not be before the last look().
  Time read(const Moment& moment) const;

 private:
  bool simulated_;
  bool frozen_ = false;
  Time reading_{0};                                   // at the last look()
  Moment last_;                                       // of the last look()
  std::chrono::steady_clock::time_point advanced_{};  // when ROS time was last seen to advance
};

}  // namespace hgrid
