// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

#include <vector>

#include "hgrid_proximity/bodies/body.h"

namespace hgrid {

/// Chooses the time for which a tick computes all poses.
class TickTime {
 public:
  /// @param max_wait  [s] how far a tick may stay behind the newest data in order to wait for slower frames
  explicit TickTime(double max_wait);

  /// Returns the newest time at which every frame that keeps up is known. This time never runs back within an epoch.
  ///
  /// A frame does not keep up if it is more than max_wait behind the newest frame. A frame whose stamp is more than
  /// max_wait ahead of ROS time does not count as the newest one. Localization nodes stamp their transforms ahead of
  /// time on purpose; so no frame that is ahead counts if another frame is up to date, at most max_wait behind ROS
  /// time.
  /// @param newest  for each chain of transforms that moves: the newest time at which the whole chain is known
  /// @param now     current ROS time, which is returned if nothing moves
  Time choose(const std::vector<Time>& newest, Time now);
  /// Returns the oldest time that a chain may have to keep up, by the last choose().
  Time keepsUpFrom() const { return keeps_up_from_; }
  /// Begins a new epoch. The next time of a tick may be before the last one.
  void beginEpoch() { last_ = Time(0); }

 private:
  Time max_wait_;
  Time last_{0};
  Time keeps_up_from_{0};
};

}  // namespace hgrid
