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
  /// @param speed  simulated seconds per real second
  explicit SimulatedClock(double begin, double speed = 1.0);

  ros::Time now() const;
  /// Starts or stops the clock. A stopped clock publishes nothing, like the clock of a paused simulation.
  void run(bool running);
  /// Jumps to another time [s].
  void set(double time);

 private:
  void publish();

  const double speed_;
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
