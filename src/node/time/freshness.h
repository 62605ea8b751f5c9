// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
//
// Functions that decide how far the pose in use of a frame, or the cells of a cloud, can be trusted.
#pragma once

#include "hgrid_proximity/bodies/body.h"

namespace hgrid {

class KeptPose;

/// Ages [s] at which data become LATE, STALE and LOST, unless their period is long.
struct AgeLimits {
  double late_after = 0.1, stale_after = 0.25, lost_after = 2.0;
};

/// Returns the state of data of a given age.
///
/// LATE, STALE and LOST begin at their limits, but not before one and a half periods.
/// @param age     [s] age of the data
/// @param period  [s] usual time between arrivals of data; 0: not known yet
Freshness freshnessOf(double age, double period, const AgeLimits& limits);

/// What the state of a pose depends on, besides the pose itself.
struct PoseCircumstances {
  Time reading{0};            ///< reading of the age clock in this tick
  Time tick_time{0};          ///< [ROS time] time of the tick; a pose with an older stamp is at least LATE
  double period = 0.0;        ///< [s] longest period of a frame of the chain; 0: not known yet
  bool refused = false;       ///< whether the newest transform was refused, or the frame is contested
  bool clock_frozen = false;  ///< whether ROS time stands still, so that new data cannot be recognized
  /// Worst state of a frame of the chain. Each is judged by the age and the period of its own transforms.
  Freshness chain = Freshness::fresh;
};

/// Returns the state of the pose in use of a frame. A settled pose does not age: it is FRESH unless a transform was
/// refused (INVALID) or the clock stands still (FROZEN).
Freshness judgePose(const KeptPose& pose, const PoseCircumstances& circumstances, const AgeLimits& limits);

/// Returns the state of the cells of a cloud. They are LOST at the end of their lifetime, whatever the period is.
/// @param age     [s] age of the newest message that was used
/// @param limits  its lost_after must be the lifetime of the cells
Freshness judgeCloud(double age, double period, bool clock_frozen, const AgeLimits& limits);

}  // namespace hgrid
