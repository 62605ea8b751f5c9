// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

#include <ros/node_handle.h>
#include <ros/steady_timer.h>

#include <chrono>
#include <functional>
#include <vector>

#include "node/diagnostics/ledger.h"

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

/// Runs chores regularly, on the thread that serves a node handle.
class Housekeeping {
 public:
  /// @param period  [s] time between two checks whether chores are due
  Housekeeping(const ros::NodeHandle& node, double period, ChoreList chores);

  void start();
  void stop() { timer_.stop(); }

 private:
  ros::NodeHandle node_;
  const double period_;
  ChoreList chores_;
  ros::SteadyTimer timer_;
};

}  // namespace hgrid
