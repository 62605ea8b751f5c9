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
  Time stamp{0};  ///< 0: it is not known at which time the frame had this pose
  std::uint32_t parent = FrameTable::kNone;
  /// Whether the pose may be interpolated between the previous sample and this one. False after an outage, and for the
  /// first sample of another publisher or parent. Then the two samples are called a seam.
  bool continues = true;
  FramePose parent_from_frame;
};

/// Stores the poses of one frame in its parent, and the times for which the pose is not known.
///
/// A static frame has one pose, which is valid at any time. A frame that moves has samples. Between two samples that do
/// not form a seam, the pose is interpolated as tf2 does it.
class FrameHistory {
 public:
  /// Whether the frame is published on /tf. Otherwise it is static, or it has no pose at all.
  bool moves() const { return moves_; }
  /// Returns the sample with the newest stamp. For a static frame, this is its only pose.
  const PoseSample& newest() const { return samples_.empty() ? kNoSample : samples_.back(); }

  /// Starts to load the newest sample, and usually the place of the next one, into the processor's cache.
  void prefetchNewest() const;

  /// Makes the frame static at this pose.
  void fix(const PoseSample& sample);
  /// Adds a sample and makes it the newest one. Drops all samples with later stamps.
  /// @param keep_from  samples before this time are dropped, except the new one
  void advance(const PoseSample& sample, Time keep_from);
  /// Adds a sample that is not the newest. If there already is a sample with the same stamp, that one is kept.
  /// @returns false if the sample is too old to be kept, or older than the newest seam; then nothing was changed
  bool fill(const PoseSample& sample);
  /// Drops the oldest samples beyond `most`, which must not be 0. @returns how many were dropped
  std::size_t trim(std::size_t most);
  /// Drops all stamps. The newest pose stays, but its time is no longer known.
  void forgetStamps();

  /// Returns the pose at a time in the newest parent. Empty: the pose is not known.
  std::optional<FramePose> at(Time time) const;
  /// Returns the pose at a time in the parent that the frame had at that time. Empty: the pose is not known.
  std::optional<PoseSample> sampleAt(Time time) const;
  /// Returns the newest time, not after `time`, for which at() knows the pose. Empty: there is none. Call this only for
  /// a frame that moves.
  std::optional<Time> newestKnownTime(Time time) const;
  /// Says why the pose at `time` is not known, for example "is known from 10 s to 12 s". Call this only for a frame
  /// that moves.
  std::string knownTimes(Time time) const;

 private:
  using Samples = std::deque<PoseSample>;  // adding a sample at an end does not copy the others
  static const PoseSample kNoSample;

  /// Number of samples that are dropped together. The oldest sample has left the processor's cache, so looking at it
  /// for each new sample would take longer than everything else that advance() does.
  static constexpr std::size_t kDropped = 16;

  Samples::const_iterator first() const;
  /// Returns the first sample whose stamp is after `time`.
  Samples::const_iterator after(Time time) const;
  void replaceFrom(const PoseSample& sample);
  void dropSome();
  void dropAll();

  bool moves_ = false;
  std::uint8_t pushed_ = 0;  // number of samples that were added since dropSome()
  Samples samples_;          // sorted by stamp, each stamp once; those before first() are no longer valid
  Time kept_from_{0};        // fill() refuses samples before this time
};

}  // namespace hgrid
