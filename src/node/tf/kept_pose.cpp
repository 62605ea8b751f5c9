// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#include "node/tf/kept_pose.h"

namespace hgrid {
namespace {

constexpr double kPeriods = 1.5;  // that a frame may be old without being LATE

}  // namespace

void KeptPose::renew(Time stamp, Time born) {
  exists_ = true;
  settled_ = frozen_ = false;
  stamp_ = stamp;
  born_ = born;
}

void KeptPose::settle(Time stamp) {
  renew(stamp, Time(0));
  settled_ = true;
}

void KeptPose::unsettle(Time stamp, Time reading) {
  if (settled_) renew(stamp, reading);
}

void KeptPose::restamp(Time reading, Time ros, bool lost) {
  if (!exists_ || settled_) return;
  stamp_ = ros - (reading - born_);
  frozen_ = frozen_ || lost;
}

Freshness KeptPose::state(Time reading, Time tick, double period, const AgeLimits& limits) const {
  if (settled_) return Freshness::fresh;
  if (frozen_) return Freshness::frozen;
  const double now = age(reading), periods = kPeriods * period;
  if (now > limits.lost_after) return Freshness::lost;
  if (now > std::max(limits.stale_after, periods)) return Freshness::stale;
  return now > std::max(limits.late_after, periods) || stamp_ < tick ? Freshness::late : Freshness::fresh;
}

}  // namespace hgrid
