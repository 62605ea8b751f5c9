// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

#include <chrono>
#include <optional>

namespace hgrid {

/// Decides when the next tick begins.
///
/// If ticks follow the data, a tick begins as soon as there is a reason for it: new data, or a waiting change of the
/// world. There are at most `rate` ticks per second. Without a reason, a tick begins when the newest one is one period
/// of `heartbeat` old. If ticks do not follow the data, they begin at regular times, `rate` times per second.
///
/// All times are readings of the steady clock.
class TickPace {
 public:
  using Time = std::chrono::steady_clock::time_point;
  using Duration = std::chrono::steady_clock::duration;

  /// @param rate          [Hz] largest number of ticks per second; in a second that begins with a tick there may be one
  ///                      more, because a tick that came late does not delay the next one by a whole period
  /// @param heartbeat     [Hz] smallest number of ticks per second if ticks follow the data
  /// @param follows_data  whether ticks follow the data
  /// @param start         the first tick may begin at this time
  TickPace(double rate, double heartbeat, bool follows_data, Time start);

  /// Notes that there is a reason for a tick, and since when. Later calls before the next tick change nothing.
  void noteReason(Time since);
  /// Notes that a change of the world waits, and since when. While ticks follow each other at the rate, the change
  /// waits for the tick that the next data begins. A tick of its own would delay the ticks after it, because each of
  /// them may begin only one period after the one before.
  void noteChange(Time since);
  /// Returns when the next tick begins, by what is known now.
  Time due() const;
  /// Notes that a tick begins now, and plans the next one.
  void noteTick(Time now);

  Duration period() const { return period_; }

 private:
  Duration period_, heartbeat_;
  bool follows_data_;
  Time earliest_, latest_;  // the next tick begins between them; the same time if ticks do not follow the data
  std::optional<Time> reason_, change_;
};

}  // namespace hgrid
