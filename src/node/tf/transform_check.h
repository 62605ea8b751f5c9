// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

#include "node/time/clock_watch.h"
#include "node/wire/transform_view.h"

namespace hgrid {

/// Checks a received transform: the names of its frames, its numbers and, if it arrived on /tf, its stamp.
/// @param max_future  [s] how far a stamp may be ahead of ROS time
/// @throws Refusal bad_id, nonfinite, out_of_range, bad_rotation or clock. The sentence names the frame.
void checkTransform(const TransformView& transform, bool is_static, const Moment& now, double max_future);
/// Does the same, except that it does not check the names.
void checkValues(const TransformView& transform, bool is_static, const Moment& now, double max_future);

}  // namespace hgrid
