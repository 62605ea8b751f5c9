// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "node/tf/tf_intake.h"
#include "node/tf/tf_tree.h"
#include "node/time/kept_pose.h"
#include "node/time/tick_time.h"

namespace hgrid {

/// Turns transforms into the poses of frames in the world frame at the time of a tick.
///
/// Usage per tick: plan() if stale(), look(), then find() for each frame. One thread, that of the TfIntake.
class FramePoses {
 public:
  /// Where a frame is, and when it was there.
  struct Found {
    FramePose world_from_frame;
    Time stamp{0};
    Time born{0};  ///< reading of the age clock at which the pose was 0 s old
  };

  /// @param max_wait  as in TickTime
  FramePoses(const TfIntake& intake, double max_wait) : intake_(intake), tree_(intake), time_(max_wait) {}

  /// Whether tf has learned of frames or parents since the last plan().
  bool stale() const { return tree_.stale(); }
  /// Lays out the chains to `frames`. All other functions refer to a frame by its index in `frames`.
  void plan(const std::string& world_frame, const std::vector<std::string>& frames);
  /// Reads what is known, chooses the time of the tick and computes all poses at that time.
  void look(const Moment& now);
  void beginEpoch() { time_.beginEpoch(); }

  /// [ROS time] Of this tick, and of the one before.
  Time tickTime() const { return tick_time_; }
  Time tickTimeBefore() const { return tick_time_before_; }
  /// Reading of the age clock in this tick, and in the one before.
  Time reading() const { return reading_; }
  Time readingBefore() const { return reading_before_; }
  const ChainState& chain(std::size_t frame) const { return tree_.state(frame); }
  /// The pose of a frame at the time of the tick. A frame that lags: at the newest time at which its chain is known.
  /// Empty: no pose can be computed, and the one in use stays.
  /// @param in_use  the pose in use. An older one does not replace it, except at the time of the tick. If there is
  ///                none, the newest pose is found even if it is younger than the tick.
  std::optional<Found> find(std::size_t frame, const KeptPose& in_use) const;
  /// What is wrong with the transforms of a frame: the newest one was refused, or publishers fight. With code
  /// unknown_frame: why the frame is not connected to the world frame. Empty: nothing is wrong.
  std::optional<Refusal> troubleOf(std::size_t frame) const;
  /// If the frame is not connected: the frame that was never published; empty if all were.
  const std::string& unknownFrame(std::size_t frame) const { return tree_.unknownFrame(frame); }

 private:
  Refusal notConnected(std::size_t frame) const;
  std::uint32_t contestedFrom(std::uint32_t number) const;

  const TfIntake& intake_;
  TfTree tree_;
  TickTime time_;
  std::string world_frame_;
  std::vector<std::string> frames_;
  std::vector<Time> newest_;  // of the chains that move: scratch of look()
  Time tick_time_{0}, tick_time_before_{0}, reading_{0}, reading_before_{0};
};

}  // namespace hgrid
