// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#include "node/tf/clock_watch.h"

#include <ros/time.h>

namespace hgrid {
namespace {

constexpr double kSmallStep = 0.1;  // [s] a wall clock that is being adjusted may go back by this

}  // namespace

Moment thisMoment() {
  Moment moment;
  moment.ros = Time(static_cast<std::int64_t>(ros::Time::now().toNSec()));
  moment.steady = std::chrono::steady_clock::now();
  return moment;
}

ClockWatch::Event ClockWatch::look(const Moment& now) {
  Event event = Event::none;
  if (running()) {
    const double by_ros = seconds(now.ros - last_.ros);
    const double by_steady = std::chrono::duration<double>(now.steady - last_.steady).count();
    if (by_ros < (simulated_ ? 0.0 : -kSmallStep)) event = Event::jumped_back;
    if (by_ros > by_steady + jump_) event = Event::jumped_ahead;
  }
  if (now.ros != last_.ros) advanced_ = now.steady;
  last_ = now;
  frozen_ = simulated_ && running() && std::chrono::duration<double>(now.steady - advanced_).count() > frozen_after_;
  return event;
}

}  // namespace hgrid
