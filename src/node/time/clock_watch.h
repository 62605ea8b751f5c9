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

/// Detects jumps and standstills of ROS time by comparing it with the steady clock.
///
/// A jump stays pending until noteHandled(), so that a tick that fails while it handles the jump is made up for.
class ClockWatch {
 public:
  enum class Event { none, jumped_back, jumped_ahead };

  /// @param simulated    /clock drives ROS time; otherwise it is the wall clock
  /// @param jump         [s] running ahead of the steady clock by more than this is a jump
  /// @param frozen_after [s] a simulated clock that stands still for longer is frozen
  ClockWatch(bool simulated, double jump, double frozen_after)
      : simulated_(simulated), jump_(jump), frozen_after_(frozen_after) {}

  /// Reads both clocks. @returns the jump that is pending; of two pending jumps, the one back
  Event look(const Moment& now);
  /// The pending jump was handled.
  void noteHandled() { pending_ = Event::none; }
  /// Whether a simulated clock was seen and now stands still.
  bool frozen() const { return frozen_; }
  /// Whether there is a time at all. Under /use_sim_time there is none before the first message on /clock.
  bool running() const { return last_.ros.count() > 0; }
  bool simulated() const { return simulated_; }

 private:
  Event jumpTo(const Moment& now) const;

  bool simulated_;
  double jump_, frozen_after_;
  bool frozen_ = false;
  Event pending_ = Event::none;
  Moment last_;
  std::chrono::steady_clock::time_point advanced_{};
};

}  // namespace hgrid
