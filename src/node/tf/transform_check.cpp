// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#include "node/tf/transform_check.h"

#include <cmath>

#include "hgrid_proximity/geometry/pose.h"
#include "hgrid_proximity/refusal.h"

namespace hgrid {
namespace {

constexpr double kFarthest = 1e9;           // [m] largest accepted coordinate of a frame in its parent
constexpr std::size_t kLongestFrame = 256;  // longest accepted frame name [bytes]

std::string whatOf(const geometry_msgs::TransformStamped& transform) {
  return "transform of frame '" + printable(transform.child_frame_id) + "'";
}

void checkNames(const geometry_msgs::TransformStamped& transform) {
  const std::string &parent = transform.header.frame_id, &child = transform.child_frame_id;
  for (const std::string* frame : {&parent, &child}) {
    if (!frame->empty() && frame->size() <= kLongestFrame) continue;
    throw Refusal(Code::bad_id, whatOf(transform) + " in '" + printable(parent) + "': a frame's name has " +
                                    std::to_string(frame->size()) + " bytes; it must have 1 .. " +
                                    std::to_string(kLongestFrame));
  }
  if (parent == child) {
    throw Refusal(Code::bad_id, whatOf(transform) + " has itself as its parent; frame and parent must differ");
  }
}

/// A quick check that most transforms pass. It builds no error sentence, which would cost time.
bool isSound(const geometry_msgs::Transform& transform) {
  const geometry_msgs::Vector3& t = transform.translation;
  const geometry_msgs::Quaternion& q = transform.rotation;
  const double norm = q.x * q.x + q.y * q.y + q.z * q.z + q.w * q.w;
  return std::abs(norm - 1.0) <= 0.5 * kQuaternionTolerance && std::abs(t.x) <= kFarthest &&
         std::abs(t.y) <= kFarthest && std::abs(t.z) <= kFarthest;
}

void checkNumbers(const geometry_msgs::TransformStamped& transform) {
  if (isSound(transform.transform)) return;
  const geometry_msgs::Vector3& t = transform.transform.translation;
  const geometry_msgs::Quaternion& q = transform.transform.rotation;
  const std::string what = whatOf(transform);
  checkWithin(checkedPose({t.x, t.y, t.z}, {q.x, q.y, q.z, q.w}, what).translation(), kFarthest, what);
}

void checkStamp(const geometry_msgs::TransformStamped& transform, const Moment& now, double max_future) {
  if (now.ros.count() == 0) {
    throw Refusal(Code::clock, whatOf(transform) + " arrived while there was no ROS time yet (no message on /clock)");
  }
  if (transform.header.stamp.isZero()) {
    throw Refusal(Code::clock,
                  whatOf(transform) + " has stamp 0; a transform on /tf must be stamped with the time of its data");
  }
  const double ahead = seconds(stampOf(transform) - now.ros);
  if (ahead > max_future) {
    throw Refusal(Code::clock, whatOf(transform) + " is stamped " + secondsText(ahead) + " in the future; at most " +
                                   text(max_future) + " s are allowed (~max_future)");
  }
}

}  // namespace

void checkTransform(const geometry_msgs::TransformStamped& transform, bool is_static, const Moment& now,
                    double max_future) {
  checkNames(transform);
  checkNumbers(transform);
  if (!is_static) checkStamp(transform, now, max_future);
}

}  // namespace hgrid
