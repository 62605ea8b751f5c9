// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#include "node/tf/tf_buffer.h"

#include <cmath>

namespace hgrid {
namespace {

constexpr double kUnitTolerance = 1e-6;  // tf2 refuses a quaternion whose length differs from 1 by more

double lengthOf(const geometry_msgs::Quaternion& q) { return std::sqrt(q.x * q.x + q.y * q.y + q.z * q.z + q.w * q.w); }

geometry_msgs::TransformStamped normalized(geometry_msgs::TransformStamped transform) {
  geometry_msgs::Quaternion& q = transform.transform.rotation;
  const double length = lengthOf(q);
  q.x /= length;
  q.y /= length;
  q.z /= length;
  q.w /= length;
  return transform;
}

}  // namespace

TfBuffer::TfBuffer(double cache, Ledger& ledger)
    : ledger_(ledger), cache_(std::llround(1e9 * cache)), buffer_(ros::Duration(cache)) {}

bool TfBuffer::feed(const geometry_msgs::TransformStamped& transform, bool is_static, const std::string& publisher) {
  if (std::abs(lengthOf(transform.transform.rotation) - 1.0) <= kUnitTolerance) {
    return buffer_.setTransform(transform, publisher, is_static);
  }
  ledger_.count("tf.renormalised");
  return buffer_.setTransform(normalized(transform), publisher, is_static);
}

}  // namespace hgrid
