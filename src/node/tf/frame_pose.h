// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

#include <geometry_msgs/Transform.h>

#include "geometry/rotation.h"
#include "hgrid_proximity/geometry/pose.h"
#include "node/wire/transform_view.h"

namespace hgrid {

/// A pose in the form that tf uses: a translation [m] and a unit quaternion.
///
/// Along a chain of frames, quaternions are multiplied instead of matrices. Then a single normalization at the end
/// yields a valid rotation, however long the chain is.
struct FramePose {
  Eigen::Quaternion<double, Eigen::DontAlign> rotation = Eigen::Quaternion<double, Eigen::DontAlign>::Identity();
  Eigen::Vector3d translation = Eigen::Vector3d::Zero();

  FramePose operator*(const FramePose& next) const {
    return {rotation * next.rotation, rotation * next.translation + translation};
  }
  bool operator==(const FramePose& other) const {
    return rotation.coeffs() == other.rotation.coeffs() && translation == other.translation;
  }
  FramePose inverse() const {
    const auto back = rotation.conjugate();
    return {back, back * -translation};
  }
  Pose pose() const {
    Pose result = Pose::Identity();
    result.linear() = rotation.normalized().toRotationMatrix();
    result.translation() = translation;
    return result;
  }
};

/// Interpolates between two poses as tf2 does. `fraction` is 0 at `from` and 1 at `to`.
inline FramePose between(const FramePose& from, const FramePose& to, double fraction) {
  FramePose result;
  result.rotation = between(Eigen::Quaterniond(from.rotation), Eigen::Quaterniond(to.rotation), fraction);
  result.translation = from.translation + fraction * (to.translation - from.translation);
  return result;
}

/// Converts a transform.
/// @param transform  must be checked already: all numbers finite, the quaternion's length nearly 1
inline FramePose toFramePose(const geometry_msgs::Transform& transform) {
  const auto& t = transform.translation;
  const auto& q = transform.rotation;
  FramePose result;
  result.rotation = Eigen::Quaternion<double, Eigen::DontAlign>(q.w, q.x, q.y, q.z).normalized();
  result.translation = {t.x, t.y, t.z};
  return result;
}

/// Converts a transform, which must be checked as above.
inline FramePose toFramePose(const TransformView& transform) {
  FramePose result;
  result.rotation = Eigen::Quaternion<double, Eigen::DontAlign>(transform.rotation.data()).normalized();
  result.translation = Eigen::Vector3d(transform.translation.data());
  return result;
}

inline geometry_msgs::Transform toTransform(const FramePose& pose) {
  geometry_msgs::Transform result;
  result.translation.x = pose.translation.x();
  result.translation.y = pose.translation.y();
  result.translation.z = pose.translation.z();
  result.rotation.x = pose.rotation.x();
  result.rotation.y = pose.rotation.y();
  result.rotation.z = pose.rotation.z();
  result.rotation.w = pose.rotation.w();
  return result;
}

}  // namespace hgrid
