// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#include "hgrid_proximity/geometry/pose.h"

#include <cmath>

#include "hgrid_proximity/refusal.h"

namespace hgrid {

Pose checkedPose(const Eigen::Vector3d& position, const Eigen::Vector4d& xyzw, const std::string& what,
                 bool* renormalized) {
  static constexpr const char* kFields[] = {"position.x",    "position.y",    "position.z",   "orientation.x",
                                            "orientation.y", "orientation.z", "orientation.w"};
  for (int i = 0; i < 7; ++i) {
    const double value = i < 3 ? position[i] : xyzw[i - 3];
    if (!std::isfinite(value)) {
      throw Refusal(Code::nonfinite, what + ": " + kFields[i] + " is " + text(value) + "; it must be finite");
    }
  }
  const double squared_norm = xyzw.cwiseAbs().maxCoeff() > 2.0 ? HUGE_VAL : xyzw.squaredNorm();  // avoids overflow
  if (!(std::abs(squared_norm - 1.0) <= kQuaternionTolerance)) {
    throw Refusal(Code::bad_rotation, what + ": the squared norm of its quaternion is " + text(squared_norm) +
                                          "; it must be within " + text(1.0 - kQuaternionTolerance) + " .. " +
                                          text(1.0 + kQuaternionTolerance));
  }
  constexpr double kUnitTolerance = 1e-6;
  if (renormalized != nullptr && std::abs(squared_norm - 1.0) > kUnitTolerance) *renormalized = true;
  Pose pose = Pose::Identity();
  pose.linear() = Eigen::Quaterniond(xyzw[3], xyzw[0], xyzw[1], xyzw[2]).normalized().toRotationMatrix();
  pose.translation() = position;
  return pose;
}

void checkWithin(const Eigen::Vector3d& position, double limit, const std::string& what) {
  for (int axis = 0; axis < 3; ++axis) {
    if (!(std::abs(position[axis]) <= limit)) {
      throw Refusal(Code::out_of_range, what + ": " + "xyz"[axis] + " is " + text(position[axis]) +
                                            " m; it must be within " + text(-limit) + " .. " + text(limit) + " m");
    }
  }
}

}  // namespace hgrid
