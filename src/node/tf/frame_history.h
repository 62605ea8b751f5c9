// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

#include <cstdint>
#include <deque>
#include <optional>
#include <string>

#include "hgrid_proximity/bodies/body.h"
#include "node/tf/frame_pose.h"
#include "node/tf/frame_table.h"

namespace hgrid {

/// The pose of a frame in its parent at one time.
struct PoseSample {
  Time stamp{0};  ///< 0: the pose has no time
  std::uint32_t parent = FrameTable::kNone;
  /// Whether the frame moved from the sample before to this one. False after an outage and where another publisher or
  /// parent begins: the pose is not known between the two samples. Such a pair of samples is called a seam.
  bool continues = true;
  FramePose parent_from_frame;
};

/// Stores where one frame was in its parent, and for which times that is not known.
///
/// A static frame has one pose, which is valid at any time. A frame that moves has samples, and between two samples
/// that continue each other the pose is interpolated as tf2 does it.
class FrameHistory {
 public:
  /// Whether the frame comes on /tf. Otherwise it is static, or nothing is known of it.
  bool moves() const { return moves_; }
  /// The sample with the newest stamp; of a static frame, its pose.
  const PoseSample& newest() const { return samples_.empty() ? kNoSample : samples_.back(); }

  /// The frame is static at this pose.
  void fix(const PoseSample& sample);
  /// Adds a sample, which is the newest from now on. Samples with later stamps are dropped.
  /// @param keep_from  samples before this time are dropped, except the new one
  void advance(const PoseSample& sample, Time keep_from);
  /// Adds a sample that is not the newest. Where a sample has the same stamp, that one stays.
  /// @returns false if the sample is older than all that is kept, or than the newest seam; then nothing was changed
  bool fill(const PoseSample& sample);
  /// Drops all stamps. The newest pose stays, but nobody knows of which time it is.
  void forgetStamps();

  /// The pose at a time in the newest parent. Empty: it is not known.
  std::optional<FramePose> at(Time time) const;
  /// The pose at a time in the parent of that time. Empty: it is not known.
  std::optional<PoseSample> sampleAt(Time time) const;
  /// The newest time, not after `time`, for which at() knows the pose. Empty: there is none. The frame moves.
  std::optional<Time> newestKnownTime(Time time) const;
  /// Says why the pose at `time` is not known, as in "is known from 10 s to 12 s". The frame moves.
  std::string knownTimes(Time time) const;

 private:
  using Samples = std::deque<PoseSample>;  // adding a sample moves none of the others
  static const PoseSample kNoSample;

  /// The first sample after `time`.
  Samples::const_iterator after(Time time) const;
  void replaceFrom(const PoseSample& sample);

  bool moves_ = false;
  Samples samples_;  // by stamp, each stamp once
  Time kept_from_{0};
};

}  // namespace hgrid
