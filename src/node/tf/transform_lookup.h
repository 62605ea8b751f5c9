// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

#include <optional>
#include <string>

#include "hgrid_proximity/bodies/body.h"
#include "node/tf/frame_pose.h"
#include "node/tf/transform_store.h"

namespace hgrid {

/// Looks up the pose of one tf frame in another. Everything but a tick uses this class for that. Any thread.
///
/// A tick uses FramePoses instead, which computes the poses of thousands of frames at one time.
class TransformLookup {
 public:
  /// @param store  must outlive this
  explicit TransformLookup(const TransformStore& store) : store_(store) {}

  /// Whether a chain of transforms connects the frames now.
  bool isConnected(const std::string& target, const std::string& frame) const;
  /// Whether at() knows the pose.
  bool isKnown(const std::string& target, const std::string& frame, Time time) const;

  /// The pose of `frame` in `target` at exactly this time. Empty: it is not known.
  /// @param why_not  if given, gets the reason, as in "frame 'arm' is known from 10 s to 12 s"
  std::optional<FramePose> at(const std::string& target, const std::string& frame, Time time,
                              std::string* why_not = nullptr) const;
  /// The newest known pose of `frame` in `target`.
  std::optional<FramePose> newest(const std::string& target, const std::string& frame) const;
  /// The pose at exactly this time or, if it is not known for that time, the newest known one.
  /// @param max_apart  [s] the most that the time of the newest pose may differ from `time`
  /// @param what       names the frame in a refusal, as in "the query's frame 'gripper'"
  /// @throws Refusal unknown_frame, or extrapolation if the newest pose is farther apart
  Pose atOrNewest(const std::string& target, const std::string& frame, Time time, double max_apart,
                  const std::string& what) const;

 private:
  const TransformStore& store_;
};

}  // namespace hgrid
