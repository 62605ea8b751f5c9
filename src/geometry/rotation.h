// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

#include <Eigen/Geometry>

namespace hgrid {

// Rotations that are made of directions and angles. Each is a rotation to a few units in the last place, whatever the
// direction, and has the same digits on all systems.

/// Returns a rotation whose z axis has the given direction. Which x axis it has is not specified.
/// @param direction  finite and not 0
Eigen::Matrix3d rotationAlong(const Eigen::Vector3d& direction);

/// Returns the rotation by roll, pitch and yaw [rad]: about the fixed axes x, then y, then z (REP-103).
Eigen::Quaterniond rotationOf(const Eigen::Vector3d& roll_pitch_yaw);

/// Interpolates between two unit quaternions at constant speed, on the shorter way. `fraction` is 0 at `from` and 1 at
/// `to`.
Eigen::Quaterniond between(const Eigen::Quaterniond& from, const Eigen::Quaterniond& to, double fraction);

/// Returns the sine of an angle [rad], with an error of a few units in the last place of 1.
double sine(double angle);
/// Returns the cosine of an angle [rad], with an error of a few units in the last place of 1.
double cosine(double angle);

}  // namespace hgrid
