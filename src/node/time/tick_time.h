// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

#include <vector>

#include "hgrid_proximity/bodies/body.h"

namespace hgrid {

/// Chooses the time at which a tick takes all poses.
class TickTime {
 public:
  /// @param max_wait  [s] the most by which a tick stays behind the newest data to wait for slower frames
  explicit TickTime(double max_wait);

  /// The newest time at which every frame that keeps up is known. It never runs back within an epoch.
  ///
  /// A frame that is more than max_wait behind the newest one does not keep up. A frame that is stamped more than
  /// max_wait ahead of the clock does not set the pace.
  /// @param newest  for each chain of transforms that moves: the newest time at which the whole chain is known
  /// @param now     ROS time. It is chosen if nothing moves.
  Time choose(const std::vector<Time>& newest, Time now);
  /// Begins a new epoch. The next time may be before the last one.
  void beginEpoch() { last_ = Time(0); }

 private:
  Time max_wait_;
  Time last_{0};
};

}  // namespace hgrid
