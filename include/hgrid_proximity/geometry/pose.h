// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

#include <Eigen/Geometry>
#include <string>

namespace hgrid {

/// A rigid motion in double precision [m]. Named `a_from_b`: it takes coordinates in b to
/// coordinates in a, so that neighbours cancel: world_from_body * body_from_shape.
/// Not aligned beyond a double, so that it can stand in any container and any interface.
using Pose = Eigen::Transform<double, 3, Eigen::Isometry, Eigen::DontAlign>;

/// How far the squared norm of an accepted quaternion may be from 1.
inline constexpr double kQuaternionTolerance = 0.03;

/// The pose of a position [m] and a quaternion from outside.
///
/// A quaternion whose squared norm is within kQuaternionTolerance of 1 is normalised; if it was off
/// by more than 1e-6, `*renormalised` is set (it is never cleared; null: not asked).
/// @param what  names the thing in the sentence of a refusal, as in "transform of frame 'tool0'"
/// @throws Refusal nonfinite or bad_rotation, naming the field.
Pose checkedPose(const Eigen::Vector3d& position, const Eigen::Vector4d& xyzw, const std::string& what,
                 bool* renormalised = nullptr);

/// Checks that every coordinate of `position` [m] is within -limit .. limit, the limit itself included.
/// @throws Refusal out_of_range, naming the axis, the value and the limit.
void checkWithin(const Eigen::Vector3d& position, double limit, const std::string& what);

}  // namespace hgrid
