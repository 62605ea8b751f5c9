// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <string>

#include "hgrid_proximity/bodies/body.h"
#include "node/tf/frame_pose.h"
#include "node/tf/transform_store.h"

namespace hgrid {

/// Says why the pose of a frame is not used, for TransformStore::isFreeButStatic().
std::string freeButStatic(const std::string& frame);

/// Looks up the pose of one tf frame in another. Any thread may use this class.
///
/// Ticks do not use it. They use FramePoses, which computes the poses of thousands of frames at one time.
class TransformLookup {
 public:
  /// @param store  must outlive this object
  explicit TransformLookup(const TransformStore& store) : store_(store) {}

  /// Whether a chain of transforms connects the frames now.
  bool isConnected(const std::string& target, const std::string& frame) const;
  /// Whether at() would return a pose.
  bool isKnown(const std::string& target, const std::string& frame, Time time) const;

  /// Returns the pose of `frame` in `target` at exactly this time. Empty: the pose is not known.
  /// @param why_not  if not null: receives the reason, for example "frame 'arm' is known from 10 s to 12 s"
  std::optional<FramePose> at(const std::string& target, const std::string& frame, Time time,
                              std::string* why_not = nullptr) const;
  /// Returns the newest known pose of `frame` in `target`. Empty: no pose is known.
  std::optional<FramePose> newest(const std::string& target, const std::string& frame) const;
  /// Returns the nearest frame above `frame` now that is a key of `frames`; empty: there is none.
  std::string nearestAbove(const std::string& frame, const std::map<std::string, std::uint32_t>& frames) const;
  /// Returns the pose at exactly this time. If it is not known, returns the newest known pose.
  /// @param max_apart  [s] how much the time of the newest pose may differ from `time`
  /// @param what       names the frame in error sentences, for example "the query's frame 'gripper'"
  /// @throws Refusal unknown_frame if no pose is known, extrapolation if the newest pose is more than max_apart away
  Pose atOrNewest(const std::string& target, const std::string& frame, Time time, double max_apart,
                  const std::string& what) const;

 private:
  const TransformStore& store_;
};

}  // namespace hgrid
