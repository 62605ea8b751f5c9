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

/// Does chores at regular times on the thread of a node handle. A chore that throws leaves the others.
class Housekeeping {
 public:
  using Time = std::chrono::steady_clock::time_point;
  struct Chore {
    const char* fault;                ///< counter of its exceptions
    std::chrono::milliseconds pause;  ///< from one time to the next; 0: whenever the timer fires
    std::function<void(Time now)> act;
  };

  /// @param period  [s] of the timer
  Housekeeping(const ros::NodeHandle& node, double period, std::vector<Chore> chores, Ledger& ledger);
  void start();
  void stop() { timer_.stop(); }

  /// Does the chores that are due. The timer calls this.
  void doChores(Time now);

 private:
  struct Planned {
    Chore chore;
    Time next{};
  };
  ros::NodeHandle node_;
  double period_;
  std::vector<Planned> plan_;
  Ledger& ledger_;
  ros::SteadyTimer timer_;
};

}  // namespace hgrid
