// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

#include <geometry_msgs/Pose.h>
#include <shape_msgs/Plane.h>

#include <string>

namespace hgrid {

/// Returns the pose at which the half-space z <= 0 is the solid side of a plane.
///
/// A shape_msgs/Plane is the equation a x + b y + c z + d = 0 in the frame of `pose`. The solid side is where the left
/// side of the equation is negative, so (a, b, c) points out of it. The length of (a, b, c) does not matter.
/// @param what  name of the object for the error sentence
/// @throws Refusal nonfinite; bad_geometry if a, b and c are all 0; what fromPose() throws for the pose
geometry_msgs::Pose poseOf(const shape_msgs::Plane& plane, const geometry_msgs::Pose& pose, const std::string& what);

/// Returns the plane z = 0, solid below.
shape_msgs::Plane horizontalPlane();

}  // namespace hgrid
