// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

#include <geometry_msgs/TransformStamped.h>

#include "node/time/clock_watch.h"

namespace hgrid {

/// Checks a received transform: the names of its frames, its numbers and, if it arrived on /tf, its stamp.
/// @param max_future  [s] how far a stamp may be ahead of ROS time
/// @throws Refusal bad_id, nonfinite, out_of_range, bad_rotation or clock. The sentence names the frame.
void checkTransform(const geometry_msgs::TransformStamped& transform, bool is_static, const Moment& now,
                    double max_future);

/// Returns the stamp of a transform.
inline Time stampOf(const geometry_msgs::TransformStamped& transform) {
  return Time(static_cast<std::int64_t>(transform.header.stamp.toNSec()));
}

}  // namespace hgrid
