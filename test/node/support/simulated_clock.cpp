// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#include "simulated_clock.h"

#include <rosgraph_msgs/Clock.h>

namespace hgrid {
namespace test {

SimulatedClock::SimulatedClock(double begin, double speed)
    : speed_(speed),
      time_(begin),
      last_(ros::SteadyTime::now()),
      publisher_(node_.advertise<rosgraph_msgs::Clock>("/clock", 10)),
      ticker_(std::chrono::milliseconds(10), [this] { publish(); }) {}

ros::Time SimulatedClock::now() const {
  const std::lock_guard<std::mutex> lock(mutex_);
  return time_;
}

void SimulatedClock::run(bool running) {
  const std::lock_guard<std::mutex> lock(mutex_);
  running_ = running;
}

void SimulatedClock::set(double time) {
  const std::lock_guard<std::mutex> lock(mutex_);
  time_ = ros::Time(time);
}

void SimulatedClock::publish() {
  const std::lock_guard<std::mutex> lock(mutex_);
  const ros::SteadyTime now = ros::SteadyTime::now();
  if (running_) {
    time_ += ros::Duration(speed_ * (now - last_).toSec());
    rosgraph_msgs::Clock message;
    message.clock = time_;
    publisher_.publish(message);
  }
  last_ = now;
}

}  // namespace test
}  // namespace hgrid
