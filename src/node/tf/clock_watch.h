// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

#include <chrono>

#include "hgrid_proximity/bodies/body.h"

namespace hgrid {

/// Both clocks at one moment: ROS time (which /clock may drive) and the steady clock (which nothing can).
struct Moment {
  Time ros{0};
  std::chrono::steady_clock::time_point steady;
};

/// Both clocks now.
Moment thisMoment();

/// Compares ROS time with the steady clock and says when it jumped or stands still.
class ClockWatch {
 public:
  enum class Event { none, jumped_back, jumped_ahead };

  /// @param simulated    /clock drives ROS time; otherwise it is the wall clock
  /// @param jump         [s] running ahead of the steady clock by more than this is a jump
  /// @param frozen_after [s] a simulated clock that stands still for longer is frozen
  ClockWatch(bool simulated, double jump, double frozen_after)
      : simulated_(simulated), jump_(jump), frozen_after_(frozen_after) {}

  Event look(const Moment& now);
  /// A simulated clock that was seen and stands still.
  bool frozen() const { return frozen_; }
  /// There is a time at all: a simulated clock has been heard of.
  bool running() const { return last_.ros.count() > 0; }
  bool simulated() const { return simulated_; }

 private:
  bool simulated_;
  double jump_, frozen_after_;
  bool frozen_ = false;
  Moment last_;
  std::chrono::steady_clock::time_point advanced_{};
};

}  // namespace hgrid
