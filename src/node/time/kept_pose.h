// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

#include <algorithm>

#include "hgrid_proximity/bodies/body.h"

namespace hgrid {

/// Stores the stamp and the age of the pose in use of a frame. freshness.h decides how far that pose can be trusted.
///
/// The pose itself is stored in the Scene. Readings are readings of the AgeClock.
class KeptPose {
 public:
  /// Whether a pose is in use, whatever its age.
  bool exists() const { return exists_; }
  /// Whether the pose was computed from static transforms only, so that it does not age.
  bool settled() const { return settled_; }
  /// Whether the transforms of this pose were dropped after a jump of the clock, and no new ones have arrived since.
  bool frozen() const { return frozen_; }
  /// Returns the stamp of the pose [ROS time]. For a settled pose, this is the time of the tick that computed it.
  Time stamp() const { return stamp_; }
  /// Returns the age of the pose [s]. The age of a settled pose is 0.
  double age(Time reading) const { return settled_ ? 0.0 : seconds(std::max(Time(0), reading - born_)); }

  /// Starts to use another pose. @param born  reading of the age clock when that pose was 0 s old
  void renew(Time stamp, Time born);
  /// Starts to use a pose that was computed from static transforms only.
  void settle(Time stamp);
  /// Lets a settled pose age again, because static transforms alone no longer determine it. They last did so at the
  /// time `stamp`, when the age clock showed `reading`. The pose ages from that reading on.
  void unsettle(Time stamp, Time reading);
  /// Moves the stamp to the new ROS time after that clock was set. The age stays the same.
  /// @param lost  whether the transforms were dropped as well; then the pose is FROZEN until another one replaces it
  void restamp(Time reading, Time ros, bool lost);

 private:
  bool exists_ = false, settled_ = false, frozen_ = false;
  Time stamp_{0};
  Time born_{0};
};

}  // namespace hgrid
