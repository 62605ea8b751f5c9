// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

#include <chrono>

#include "hgrid_proximity/bodies/body.h"

namespace hgrid {

/// The readings of both clocks at one moment: ROS time, which /clock may drive, and the steady clock.
struct Moment {
  Time ros{0};
  std::chrono::steady_clock::time_point steady;
};

/// Reads both clocks now.
Moment thisMoment();

/// Detects jumps and standstills of ROS time by comparing it with the steady clock.
///
/// A jump stays pending until noteHandled(). So if a tick fails while it handles the jump, the next tick handles it.
class ClockWatch {
 public:
  enum class Event { none, jumped_back, jumped_ahead };

  /// @param simulated    whether /clock drives ROS time; otherwise ROS time is the wall clock
  /// @param jump         [s] if ROS time gains more than this on the steady clock, it has jumped ahead
  /// @param frozen_after [s] if a simulated clock stands still for longer, it is frozen
  ClockWatch(bool simulated, double jump, double frozen_after)
      : simulated_(simulated), jump_(jump), frozen_after_(frozen_after) {}

  /// Compares both clocks with the previous look(). @returns the pending jump; a jump back takes precedence
  Event look(const Moment& now);
  /// Call this when the pending jump was handled.
  void noteHandled() { pending_ = Event::none; }
  /// Whether a simulated clock has started and now stands still.
  bool frozen() const { return frozen_; }
  /// Whether ROS time has started. With /use_sim_time, it starts with the first message on /clock.
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
