// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#include "node/moveit/scene_plane.h"

#include <Eigen/Geometry>
#include <cmath>

#include "geometry/rotation.h"
#include "hgrid_proximity/refusal.h"
#include "node/messages/to_messages.h"
#include "node/wire/from_messages.h"

namespace hgrid {

geometry_msgs::Pose poseOf(const shape_msgs::Plane& plane, const geometry_msgs::Pose& pose, const std::string& what) {
  const Eigen::Vector3d normal(plane.coef[0], plane.coef[1], plane.coef[2]);
  if (!normal.allFinite() || !std::isfinite(plane.coef[3])) {
    throw Refusal(Code::nonfinite, what + " has a plane whose coefficients are not finite; all four must be finite");
  }
  const double length = normal.stableNorm();
  if (!(length > 0.0) || !std::isfinite(plane.coef[3] / length)) {
    throw Refusal(Code::bad_geometry, what + " has a plane with the coefficients " + text(normal.x()) + ", " +
                                          text(normal.y()) + ", " + text(normal.z()) + ", " + text(plane.coef[3]) +
                                          "; the first three must not all be 0");
  }
  Pose result = fromPose(pose, "the pose of a plane of " + what);
  const Eigen::Vector3d up = normal / length;
  Pose plane_in_pose = Pose::Identity();
  plane_in_pose.linear() = rotationAlong(up);
  plane_in_pose.translation() = -plane.coef[3] / length * up;
  return toPose(result * plane_in_pose);
}

shape_msgs::Plane horizontalPlane() {
  shape_msgs::Plane plane;
  plane.coef = {0.0, 0.0, 1.0, 0.0};
  return plane;
}

}  // namespace hgrid
