// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

#include <ros/node_handle.h>
#include <ros/steady_timer.h>

#include <chrono>
#include <functional>
#include <optional>
#include <vector>

#include "node/health/ledger.h"

namespace hgrid {

/// A task that the node repeats at regular times.
struct Chore {
  using Time = std::chrono::steady_clock::time_point;
  const char* fault;                ///< name of the counter that counts its exceptions
  std::chrono::milliseconds pause;  ///< shortest time between two runs; 0: the task runs at every call of doDue()
  std::function<void(Time now)> act;
};

/// A list of chores, each with its own pause. If a chore throws, the others still run. Only one thread may use a list.
class ChoreList {
 public:
  using Time = Chore::Time;
  ChoreList(std::vector<Chore> chores, Ledger& ledger);

  /// Runs the chores whose pauses are over, in the order of the list.
  void doDue(Time now);

 private:
  struct Planned {
    Chore chore;
    Time next{};
  };
  std::vector<Planned> plan_;
  Ledger& ledger_;
};

/// Decides when a chore is due that must run at a given rate. Only one thread may use it.
class ChorePace {
 public:
  using Time = Chore::Time;

  /// @param rate  [Hz] > 0
  explicit ChorePace(double rate) { setRate(rate); }
  void setRate(double rate);

  /// Returns the time [s] between two calls of takeDue() with which the chore runs at its rate. It is at most 0.25 s,
  /// and a whole number of these times is the time between two runs of the chore.
  double period() const { return period_; }
  /// Returns whether the chore is due. If it is, the caller must run it now.
  bool takeDue(Time now);

 private:
  double period_ = 0.0;             // [s]
  std::chrono::nanoseconds pause_;  // half a period shorter than the time between two runs, as timers are not exact
  std::optional<Time> last_;
};

/// Runs chores regularly, on the thread that serves a node handle.
class Housekeeping {
 public:
  /// @param period  [s] time between two checks whether chores are due
  Housekeeping(const ros::NodeHandle& node, double period, ChoreList chores);

  void start();
  /// Sets the time between two checks [s]. Call this on the thread of the chores, or before start().
  void setPeriod(double period);
  void stop() { timer_.stop(); }

 private:
  ros::NodeHandle node_;
  double period_;
  ChoreList chores_;
  ros::SteadyTimer timer_;
};

}  // namespace hgrid
