// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

#include <algorithm>

#include "hgrid_proximity/bodies/body.h"

namespace hgrid {

/// The stamp and the age of the pose in use of a frame. See freshness.h for how far such a pose can be trusted.
///
/// The pose itself is stored in the Scene. Readings are those of the AgeClock.
class KeptPose {
 public:
  /// Whether a pose is in use, whatever its age.
  bool exists() const { return exists_; }
  /// Only static transforms give the pose, so it does not age.
  bool settled() const { return settled_; }
  /// The transforms that gave the pose were dropped after a jump of the clock, and no new ones came since.
  bool frozen() const { return frozen_; }
  /// [ROS time] of the pose. If the pose is settled: the tick that computed it.
  Time stamp() const { return stamp_; }
  /// [s] 0 while it is settled
  double age(Time reading) const { return settled_ ? 0.0 : seconds(std::max(Time(0), reading - born_)); }

  /// Takes another pose into use. @param born  reading at which it was 0 s old
  void renew(Time stamp, Time born);
  /// Takes a pose into use that only static transforms give.
  void settle(Time stamp);
  /// Static transforms no longer give the settled pose. They last gave it at the time `stamp`, when the age clock
  /// showed `reading`. The pose ages from then on.
  void unsettle(Time stamp, Time reading);
  /// Moves the stamp to the new ROS time after that clock was set. The age stays the same.
  /// @param lost  the transforms were dropped as well, so the pose is FROZEN until there is another one
  void restamp(Time reading, Time ros, bool lost);

 private:
  bool exists_ = false, settled_ = false, frozen_ = false;
  Time stamp_{0};
  Time born_{0};
};

}  // namespace hgrid
