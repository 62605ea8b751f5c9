// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

#include <ros/time.h>

#include <cstdint>

#include "hgrid_proximity/bodies/body.h"

namespace hgrid {

/// Returns a ROS time as the core stores it.
inline Time fromRos(const ros::Time& time) { return Time(static_cast<std::int64_t>(time.toNSec())); }

}  // namespace hgrid
