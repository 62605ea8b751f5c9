// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#include "node/time/clock_watch.h"

#include <ros/time.h>

#include "node/time/ros_time.h"

namespace hgrid {
namespace {

constexpr double kSmallStep = 0.1;  // [s] a wall clock may step back this much, because it is being adjusted

}  // namespace

Moment thisMoment() {
  Moment moment;
  moment.ros = fromRos(ros::Time::now());
  moment.steady = std::chrono::steady_clock::now();
  return moment;
}

ClockWatch::Event ClockWatch::jumpTo(const Moment& now) const {
  if (!running()) return Event::none;
  const double by_ros = seconds(now.ros - last_.ros);
  const double by_steady = std::chrono::duration<double>(now.steady - last_.steady).count();
  if (by_ros > by_steady + jump_) return Event::jumped_ahead;
  return by_ros < (simulated_ ? 0.0 : -kSmallStep) ? Event::jumped_back : Event::none;
}

ClockWatch::Event ClockWatch::look(const Moment& now) {
  const Event jump = jumpTo(now);
  // A jump back needs more work than a jump ahead. So it stays pending if both happen before a tick succeeds.
  if (jump != Event::none && pending_ != Event::jumped_back) pending_ = jump;
  if (now.ros != last_.ros) advanced_ = now.steady;
  last_ = now;
  frozen_ = simulated_ && running() && std::chrono::duration<double>(now.steady - advanced_).count() > frozen_after_;
  return pending_;
}

}  // namespace hgrid
