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

// Converts parts of requests into values of the library.

inline Eigen::Vector3d fromPoint(const geometry_msgs::Point& point) { return {point.x, point.y, point.z}; }

/// Converts a pose. An orientation of four zeros, as in a request typed by hand, means no rotation.
/// @param what  name of the pose in error messages, as in "the map's pose"
/// @throws Refusal nonfinite, bad_rotation
Pose fromPose(const geometry_msgs::Pose& pose, const std::string& what);

/// Converts a shape, without its pose, padding and resource.
/// @param max_triangles  largest number of triangles of a mesh or hull
/// @throws Refusal unsupported (queries do not accept this kind), limit, bad_geometry, nonfinite, out_of_range
Shape fromShape(const ::hgrid_proximity::Shape& shape, const ShapeLimits& limits, std::size_t max_triangles);

}  // namespace hgrid
