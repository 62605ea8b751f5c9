// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#include "node/time/kept_pose.h"

namespace hgrid {

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

}  // namespace hgrid
