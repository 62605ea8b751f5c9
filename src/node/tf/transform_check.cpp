// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#include "node/tf/transform_check.h"

#include <cmath>

#include "hgrid_proximity/geometry/pose.h"
#include "hgrid_proximity/refusal.h"

namespace hgrid {
namespace {

constexpr double kFarthestTranslation = 1e9;  // [m] largest accepted coordinate of a frame in its parent
constexpr std::size_t kLongestFrame = 256;    // longest accepted frame name [bytes]

std::string whatOf(const TransformView& transform) {
  return "transform of frame '" + printable(std::string(transform.child)) + "'";
}

void checkNames(const TransformView& transform) {
  const std::string_view parent = transform.parent, child = transform.child;
  for (const std::string_view frame : {parent, child}) {
    if (!frame.empty() && frame.size() <= kLongestFrame) continue;
    throw Refusal(Code::bad_id, whatOf(transform) + " in '" + printable(std::string(parent)) +
                                    "': a frame's name has " + std::to_string(frame.size()) +
                                    " bytes; it must have 1 .. " + std::to_string(kLongestFrame));
  }
  if (parent == child) {
    throw Refusal(Code::bad_id, whatOf(transform) + " has itself as its parent; frame and parent must differ");
  }
}

/// A quick check that most transforms pass. It builds no error sentence, which would cost time.
bool isSound(const TransformView& transform) {
  const auto& [x, y, z] = transform.translation;
  return std::abs(squaredLength(transform.rotation) - 1.0) <= 0.5 * kQuaternionTolerance &&
         std::abs(x) <= kFarthestTranslation && std::abs(y) <= kFarthestTranslation &&
         std::abs(z) <= kFarthestTranslation;
}

void checkNumbers(const TransformView& transform) {
  if (isSound(transform)) return;
  const Eigen::Vector3d translation(transform.translation.data());
  const Eigen::Vector4d xyzw(transform.rotation.data());
  const std::string what = whatOf(transform);
  checkWithin(checkedPose(translation, xyzw, what).translation(), kFarthestTranslation, what);
}

void checkStamp(const TransformView& transform, const Moment& now, double max_future) {
  if (now.ros.count() == 0) {
    throw Refusal(Code::clock, whatOf(transform) + " arrived while there was no ROS time yet (no message on /clock)");
  }
  if (transform.stamp.count() == 0) {
    throw Refusal(Code::clock,
                  whatOf(transform) + " has stamp 0; a transform on /tf must be stamped with the time of its data");
  }
  const double ahead = seconds(transform.stamp - now.ros);
  if (ahead > max_future) {
    throw Refusal(Code::clock, whatOf(transform) + " is stamped " + secondsText(ahead) + " in the future; at most " +
                                   text(max_future) + " s are allowed (~limits/max_future)");
  }
}

}  // namespace

void checkTransform(const TransformView& transform, bool is_static, const Moment& now, double max_future) {
  checkNames(transform);
  checkValues(transform, is_static, now, max_future);
}

void checkValues(const TransformView& transform, bool is_static, const Moment& now, double max_future) {
  checkNumbers(transform);
  if (!is_static) checkStamp(transform, now, max_future);
}

}  // namespace hgrid
