// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#include "node/tf/transform_lookup.h"

#include <tf2/exceptions.h>

#include <cmath>

#include "hgrid_proximity/geometry/pose.h"
#include "hgrid_proximity/refusal.h"

namespace hgrid {
namespace {

const ros::Time kNewest(0);  // as tf2 understands it

ros::Time toTf2(Time time) { return ros::Time().fromNSec(static_cast<std::uint64_t>(time.count())); }

}  // namespace

bool TransformLookup::isConnected(const std::string& target, const std::string& frame) const {
  return frame == target || buffer_.canTransform(target, frame, kNewest);
}

bool TransformLookup::isKnown(const std::string& target, const std::string& frame, Time time) const {
  return frame == target || buffer_.canTransform(target, frame, toTf2(time));
}

std::optional<FramePose> TransformLookup::at(const std::string& target, const std::string& frame, Time time,
                                             std::string* why_not) const {
  if (frame == target) return FramePose{};
  try {
    return toFramePose(buffer_.lookupTransform(target, frame, toTf2(time)).transform);
  } catch (const tf2::TransformException& error) {
    if (why_not != nullptr) *why_not = error.what();
    return std::nullopt;
  }
}

std::optional<FramePose> TransformLookup::newest(const std::string& target, const std::string& frame) const {
  return at(target, frame, Time(0));
}

Pose TransformLookup::atOrNewest(const std::string& target, const std::string& frame, Time time, double max_apart,
                                 const std::string& what) const {
  if (frame == target) return Pose::Identity();
  geometry_msgs::TransformStamped found;
  try {
    try {
      found = buffer_.lookupTransform(target, frame, toTf2(time));
    } catch (const tf2::ExtrapolationException&) {
      found = buffer_.lookupTransform(target, frame, kNewest);
      const double apart = std::abs((found.header.stamp - toTf2(time)).toSec());
      if (!found.header.stamp.isZero() && apart > max_apart) {
        throw Refusal(Code::extrapolation, what + " is known at " + text(found.header.stamp.toSec()) +
                                               " s, the world at " + text(toTf2(time).toSec()) + " s; they may be " +
                                               text(max_apart) + " s apart (~stale_after)");
      }
    }
  } catch (const tf2::TransformException& error) {
    throw Refusal(Code::unknown_frame, what + " is not connected to '" + target + "': " + printable(error.what(), 300));
  }
  const auto& t = found.transform.translation;
  const auto& q = found.transform.rotation;
  return checkedPose({t.x, t.y, t.z}, {q.x, q.y, q.z, q.w}, what);
}

}  // namespace hgrid
