// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

#include <ros/node_handle.h>

#include <mutex>

#include "ticker.h"

namespace hgrid {
namespace test {

/// Publishes /clock, a hundred times per second while it runs. Any thread.
class SimulatedClock {
 public:
  explicit SimulatedClock(double begin);

  ros::Time now() const;
  /// A clock that is stopped is silent, as in a paused simulation.
  void run(bool running);
  /// Jumps to another time [s].
  void set(double time);

 private:
  void publish();

  mutable std::mutex mutex_;
  ros::Time time_;
  ros::SteadyTime last_;
  bool running_ = true;
  ros::NodeHandle node_;
  ros::Publisher publisher_;
  Ticker ticker_;
};

}  // namespace test
}  // namespace hgrid
