// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

#include <algorithm>
#include <utility>

#include "hgrid_proximity/bodies/body.h"

namespace hgrid {

/// Stores when the newest transform of a frame arrived, and how often its transforms arrive.
class FramePace {
 public:
  /// Returns the reading of the age clock when the newest transform arrived.
  Time received() const { return received_; }
  /// Returns how far the age clock was ahead of ROS time when the newest transform arrived.
  Time lead() const { return lead_; }
  /// Returns the smoothed time between the stamps of successive transforms [s]. 0: not known yet.
  double period() const { return period_; }

  void noteReceived(Time reading) { received_ = reading; }
  void noteReceived(Time reading, Time ros) {
    received_ = reading;
    lead_ = reading - ros;
  }
  /// Learns from the time between the stamps of the two newest transforms [s].
  void noteStep(double step) {
    const double before = std::exchange(step_, step);
    const double usual = std::min(before, step_);  // ignores a single long step, which is an outage
    period_ = period_ == 0.0 ? usual : 0.9 * period_ + 0.1 * usual;
  }
  void forgetPeriod() { period_ = step_ = 0.0; }

 private:
  Time received_{0}, lead_{0};
  double period_ = 0.0;
  double step_ = 0.0;  // [s] time between the two newest stamps
};

}  // namespace hgrid
