// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
//
// Where freshness is judged: how far the pose in use of a frame, or the cells of a cloud, can be trusted.
#pragma once

#include "hgrid_proximity/bodies/body.h"

namespace hgrid {

class KeptPose;

/// Ages [s] up to which data are FRESH, LATE and STALE. Older data are LOST.
struct AgeLimits {
  double late_after = 0.1, stale_after = 0.25, lost_after = 2.0;
};

/// Judges data by their age alone.
///
/// LATE and STALE begin at their limits, or at one and a half periods where that is later. LOST begins at its limit.
/// @param age     [s]
/// @param period  [s] between arrivals; 0: not known yet
Freshness freshnessOf(double age, double period, const AgeLimits& limits);

/// What the freshness of a pose depends on, beside the pose itself.
struct PoseCircumstances {
  Time reading{0};            ///< of the age clock, in this tick
  Time tick_time{0};          ///< [ROS time] an older pose is LATE at least
  double period = 0.0;        ///< [s] between transforms of the frame; 0: not known yet
  bool refused = false;       ///< the newest transform was refused, or publishers fight over the frame
  bool clock_frozen = false;  ///< ROS time stands still, so that nothing new can be recognized
};

/// Judges the pose in use of a frame. A settled pose does not age, so only a refused transform makes it INVALID.
Freshness judgePose(const KeptPose& pose, const PoseCircumstances& circumstances, const AgeLimits& limits);

/// Judges the cells of a cloud.
/// @param age     [s] of the newest message that counts
/// @param limits  lost_after is the lifetime of the cells
Freshness judgeCloud(double age, double period, bool clock_frozen, const AgeLimits& limits);

}  // namespace hgrid
