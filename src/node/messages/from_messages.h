// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

#include <geometry_msgs/Point.h>
#include <geometry_msgs/Pose.h>
#include <hgrid_proximity/Shape.h>

#include <string>

#include "hgrid_proximity/geometry/pose.h"
#include "hgrid_proximity/geometry/shape.h"

namespace hgrid {

// Values of the library from parts of requests.

inline Eigen::Vector3d fromPoint(const geometry_msgs::Point& point) { return {point.x, point.y, point.z}; }

/// A pose. An orientation of four zeros, as in a request typed by hand, counts as none.
/// @param what  names the pose in a refusal, as in "the map's pose"
/// @throws Refusal nonfinite, bad_rotation
Pose fromPose(const geometry_msgs::Pose& pose, const std::string& what);

/// The shape alone, without its pose, padding and resource.
/// @throws Refusal unsupported (a kind that cannot be asked about), bad_geometry, nonfinite, out_of_range
Shape fromShape(const ::hgrid_proximity::Shape& shape);

}  // namespace hgrid
