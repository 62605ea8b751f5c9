// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "hgrid_proximity/bodies/body.h"
#include "node/tf/frame_pose.h"
#include "node/tf/frame_table.h"

namespace hgrid {

/// The pose of a frame in its parent at one time.
struct PoseSample {
  Time stamp{0};  ///< 0: there is no sample
  std::uint32_t parent = FrameTable::kNone;
  FramePose parent_from_frame;
};

/// Knows where one frame was in its parent, and for which times that is not known.
///
/// Between two samples the pose is interpolated. A seam is a time between two samples that do not continue each other,
/// because they come from two publishers or there was an outage: the pose is not known then.
///
/// This stores the two newest samples of a frame that moves. tf2's buffer has the older ones, except those of a frame
/// that it takes for static.
class FrameHistory {
 public:
  /// Whether the frame comes on /tf. Otherwise it has one pose, without a time.
  bool moves() const { return moves_; }
  const PoseSample& newest() const { return newest_; }

  /// The frame is static at this pose.
  void fix(const PoseSample& sample);
  /// The frame moves, and this is its newest sample.
  /// @param same_parent  the parent is that of the sample before
  /// @param keeps_all    tf2 does not store the samples of this frame, so that this must do it
  void advance(const PoseSample& sample, bool same_parent, bool keeps_all);
  /// A sample before the newest one arrived.
  void fill(const PoseSample& sample);
  /// The pose is not known from the newest sample until the time `until`.
  void addSeam(Time until);
  /// Whether a time is before the end of the newest seam.
  bool isBeforeSeam(Time time) const { return !seams_.empty() && time < seams_.back().end; }
  /// Drops all stamps. The newest pose stays, but nobody knows of which time it is.
  void forgetStamps();

  /// The pose at a time. Empty: it is not known.
  /// @param older  looks up times before the two newest samples, as in std::optional<FramePose> older(Time)
  template <class Older>
  std::optional<FramePose> at(Time time, const Older& older) const {
    if (!moves_ || time == newest_.stamp) return newest_.parent_from_frame;
    if (time > newest_.stamp || time < parent_since_ || isInSeam(time)) return std::nullopt;
    if (isBetweenNewest(time)) return interpolated(before_, newest_, time);
    return keeps_all_ ? recall(time) : older(time);
  }

 private:
  struct Seam {
    Time begin{0}, end{0};
  };

  static FramePose interpolated(const PoseSample& from, const PoseSample& to, Time time);
  bool isInSeam(Time time) const;
  bool isBetweenNewest(Time time) const {
    return before_.stamp.count() > 0 && before_.parent == newest_.parent && time >= before_.stamp;
  }
  void keep();
  std::optional<FramePose> recall(Time time) const;

  bool moves_ = false, keeps_all_ = false;
  PoseSample newest_, before_;     // before_: the one that was newest until then
  Time parent_since_{0};           // stamp of the first sample in the newest parent
  std::vector<Seam> seams_;        // the newest last
  std::vector<PoseSample> older_;  // keeps_all_: the newest samples, the newest last
};

}  // namespace hgrid
