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

/// Something that is done again and again.
struct Chore {
  using Time = std::chrono::steady_clock::time_point;
  const char* fault;                ///< counter of the exceptions that it throws
  std::chrono::milliseconds pause;  ///< from one time to the next; 0: at every call
  std::function<void(Time now)> act;
};

/// Chores, each with a pause of its own. A chore that throws leaves the others. One thread.
class ChoreList {
 public:
  using Time = Chore::Time;
  ChoreList(std::vector<Chore> chores, Ledger& ledger);

  /// Does the chores whose pauses are over, in their order.
  void doDue(Time now);

 private:
  struct Planned {
    Chore chore;
    Time next{};
  };
  std::vector<Planned> plan_;
  Ledger& ledger_;
};

/// Does chores on the thread of a node handle.
class Housekeeping {
 public:
  /// @param period  [s] how often it looks for chores that are due
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
