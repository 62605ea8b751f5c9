// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

#include <tf2/buffer_core.h>

#include <optional>
#include <string>

#include "hgrid_proximity/bodies/body.h"
#include "node/tf/frame_pose.h"

namespace hgrid {

/// Looks up the pose of one tf frame in another. Everything but a tick uses this class for that. Any thread.
///
/// A tick uses FramePoses instead, which computes the poses of thousands of frames at one time and knows when a frame's
/// transforms do not continue each other.
class TransformLookup {
 public:
  /// @param buffer  must outlive this
  explicit TransformLookup(const tf2::BufferCore& buffer) : buffer_(buffer) {}

  /// Whether a chain of transforms connects the frames at any time.
  bool isConnected(const std::string& target, const std::string& frame) const;
  /// Whether at() knows the pose.
  bool isKnown(const std::string& target, const std::string& frame, Time time) const;

  /// The pose of `frame` in `target` at exactly this time. Empty: it is not known.
  /// @param why_not  if given, gets the reason in the words of tf2
  std::optional<FramePose> at(const std::string& target, const std::string& frame, Time time,
                              std::string* why_not = nullptr) const;
  /// The newest known pose of `frame` in `target`.
  std::optional<FramePose> newest(const std::string& target, const std::string& frame) const;
  /// The pose at exactly this time or, if there are transforms of other times only, the newest one.
  /// @param max_apart  [s] the most that the time of the newest pose may differ from `time`
  /// @param what       names the frame in a refusal, as in "the query's frame 'gripper'"
  /// @throws Refusal unknown_frame, or extrapolation if the newest pose is farther apart
  Pose atOrNewest(const std::string& target, const std::string& frame, Time time, double max_apart,
                  const std::string& what) const;

 private:
  const tf2::BufferCore& buffer_;
};

}  // namespace hgrid
