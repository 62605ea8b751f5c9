// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

#include <Eigen/Geometry>
#include <string>

namespace hgrid {

/// A rigid transform in double precision [m].
///
/// A variable `a_from_b` converts coordinates of frame b to coordinates of frame a. So neighboring frame names in a
/// product cancel: world_from_body * body_from_shape. The type needs no special alignment, so any container and any
/// interface can hold it.
using Pose = Eigen::Transform<double, 3, Eigen::Isometry, Eigen::DontAlign>;

/// Largest accepted difference between the squared norm of a quaternion and 1.
inline constexpr double kQuaternionTolerance = 0.03;

/// Converts a position [m] and a quaternion that come from outside into a pose.
///
/// If the squared norm of the quaternion is within kQuaternionTolerance of 1, the quaternion is normalized. If the
/// difference from 1 is more than 1e-6, `*renormalized` is set to true. If not, `*renormalized` keeps its value. The
/// pointer may be null.
/// @param what  name of the object for the error sentence, such as "transform of frame 'tool0'"
/// @throws Refusal with code nonfinite or bad_rotation; its sentence names the field
Pose checkedPose(const Eigen::Vector3d& position, const Eigen::Vector4d& xyzw, const std::string& what,
                 bool* renormalized = nullptr);

/// Checks that every coordinate of `position` [m] is within -limit .. limit, limits included.
/// @param what  name of the object for the error sentence
/// @throws Refusal with code out_of_range; its sentence names the axis, the value and the limit
void checkWithin(const Eigen::Vector3d& position, double limit, const std::string& what);

}  // namespace hgrid
