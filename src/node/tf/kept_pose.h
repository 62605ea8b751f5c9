// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

#include <algorithm>

#include "hgrid_proximity/bodies/body.h"

namespace hgrid {

/// Ages [s] at which a pose is no longer FRESH, LATE and STALE.
struct AgeLimits {
  double late_after = 0.1, stale_after = 0.25, lost_after = 2.0;
};

/// How old the pose in use of a frame is, and how far that pose can be trusted.
///
/// The pose itself is where it is used, in the Scene. Readings are those of the AgeClock.
class KeptPose {
 public:
  /// Whether a pose is in use, whatever its age.
  bool exists() const { return exists_; }
  /// Nothing but another static transform can move it: it does not age.
  bool settled() const { return settled_; }
  /// [ROS time] of the pose; of a settled one, when it was put there.
  Time stamp() const { return stamp_; }
  /// [s] 0 while it is settled
  double age(Time reading) const { return settled_ ? 0.0 : seconds(std::max(Time(0), reading - born_)); }

  /// Another pose is in use. @param born  reading at which it was 0 s old
  void renew(Time stamp, Time born);
  /// A pose is in use that only static transforms give.
  void settle(Time stamp);
  /// The static transforms that gave a settled pose gave it until the time `stamp`, which was `reading`. From then on
  /// it ages.
  void unsettle(Time stamp, Time reading);
  /// ROS time was set: the stamp becomes one of the new time. The age stays.
  /// @param lost  the transforms are dropped as well, so the pose is FROZEN until there is another one
  void restamp(Time reading, Time ros, bool lost);

  /// How far the pose can be trusted, by its age alone. LATE and STALE begin at their limits, or at one and a half
  /// periods of the frame where that is later.
  /// @param tick    [ROS time] of the tick: an older pose is LATE at least
  /// @param period  [s] between transforms of the frame
  Freshness state(Time reading, Time tick, double period, const AgeLimits& limits) const;

 private:
  bool exists_ = false, settled_ = false, frozen_ = false;
  Time stamp_{0};
  Time born_{0};
};

}  // namespace hgrid
