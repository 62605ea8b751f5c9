// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

#include <ros/node_handle.h>

#include <mutex>

#include "ticker.h"

namespace hgrid {
namespace test {

/// Publishes /clock 100 times per second while it runs. All functions may be called from any thread.
class SimulatedClock {
 public:
  /// @param begin  [s] time at which the clock starts
  explicit SimulatedClock(double begin);

  ros::Time now() const;
  /// Starts or stops the clock. A stopped clock publishes nothing, like the clock of a paused simulation.
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
