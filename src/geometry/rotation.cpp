// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#include "geometry/rotation.h"

#include <cmath>

#include "geometry/arc_tangent.h"
#include "geometry/sine_cosine.h"

namespace hgrid {
namespace {

/// Returns an angle that sineCosine() takes.
double reduced(double angle) {
  return std::abs(angle) <= kLargestAngle ? angle : std::remainder(angle, 2.0 * M_PI);  // exact for the double 2 pi
}

}  // namespace

double sine(double angle) { return sineCosine(fourDoubles(reduced(angle))).sine[0]; }
double cosine(double angle) { return sineCosine(fourDoubles(reduced(angle))).cosine[0]; }

Eigen::Matrix3d rotationAlong(const Eigen::Vector3d& direction) {
  const Eigen::Vector3d along = direction.stableNormalized();
  // The axis that is most perpendicular to the direction. The rest of it is at least 0.8 long.
  Eigen::Index axis = 0;
  along.cwiseAbs().minCoeff(&axis);
  Eigen::Matrix3d rotation;
  rotation.col(0) = (Eigen::Vector3d::Unit(axis) - along[axis] * along).normalized();
  rotation.col(1) = along.cross(rotation.col(0));
  rotation.col(2) = along;
  return rotation;
}

Eigen::Quaterniond rotationOf(const Eigen::Vector3d& roll_pitch_yaw) {
  const auto about = [&](Eigen::Index axis) {
    const double half = 0.5 * roll_pitch_yaw[axis];
    Eigen::Quaterniond turn(cosine(half), 0.0, 0.0, 0.0);
    turn.vec()[axis] = sine(half);
    return turn;
  };
  return about(2) * about(1) * about(0);
}

Eigen::Quaterniond between(const Eigen::Quaterniond& from, const Eigen::Quaterniond& to, double fraction) {
  const Eigen::Vector4d begin = from.coeffs(), end = from.dot(to) < 0.0 ? -to.coeffs() : to.coeffs();
  const double angle = 2.0 * arcTangent((end - begin).norm(), (end + begin).norm()), whole = sine(angle);
  constexpr double kSmall = 1e-9;  // the sine of such an angle is the angle
  if (!(whole > kSmall)) return Eigen::Quaterniond(begin + fraction * (end - begin));
  return Eigen::Quaterniond((sine((1.0 - fraction) * angle) * begin + sine(fraction * angle) * end) / whole);
}

}  // namespace hgrid
