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

/// Computes the poses of frames in the world frame at the time of a tick, from the stored transforms.
///
/// Each tick calls plan() if stale(), then look(), then find() for each frame. Only the tick thread may use this class.
class FramePoses {
 public:
  /// The pose of a frame, and the time at which the frame had that pose.
  struct Found {
    FramePose world_from_frame;
    Time stamp{0};
    Time born{0};  ///< reading of the age clock when the age of the pose was 0 s
  };

  /// @param max_wait  [s] how long a tick may wait for slower frames, as in TickTime
  FramePoses(const TfIntake& intake, const AgeLimits& limits, double max_wait)
      : intake_(intake), tree_(intake, limits), time_(max_wait) {}

  /// Whether a new frame or a new parent has appeared in tf since the last plan().
  bool stale() const { return tree_.stale(); }
  /// Finds the chains of transforms to `frames`. All other functions refer to a frame by its index in `frames`.
  void plan(const std::string& world_frame, std::vector<std::string> frames);
  /// Reads the stored transforms, chooses the time of the tick and computes all poses at that time.
  void look(const Moment& now);
  void beginEpoch() { time_.beginEpoch(); }

  /// Returns the frames that hold back the time of the next tick: those of chains that keep up.
  const std::vector<FrameStamp>& awaited() const { return awaited_; }
  /// Returns the time of this tick; tickTimeBefore() returns the time of the previous tick. Both are in ROS time. In
  /// the first tick, and in the first tick after ROS time went back, both are the same.
  Time tickTime() const { return tick_time_; }
  Time tickTimeBefore() const { return tick_time_before_; }
  /// Returns the reading of the age clock in this tick; readingBefore() returns the reading in the previous tick, in
  /// the first tick that of this tick.
  Time reading() const { return reading_; }
  Time readingBefore() const { return reading_before_; }
  const ChainState& chain(std::size_t frame) const { return tree_.state(frame); }
  /// Whether the frame is the world frame itself, so that no transform can move it.
  bool isWorld(std::size_t frame) const { return tree_.isWorld(frame); }
  /// Returns the pose of a frame at the time of the tick. For a frame that lags behind, returns its pose at the newest
  /// time at which its chain is known. Empty: no pose can be computed, so the pose in use stays.
  /// @param in_use  the pose in use. A pose with an older stamp replaces it only if it is the pose at the time of the
  ///                tick. If no pose is in use yet, the newest pose is returned, even if it is newer than the tick.
  std::optional<Found> find(std::size_t frame, const KeptPose& in_use) const;
  /// Returns what is wrong with the transforms of a frame: the newest one was refused, the frame is contested, or (code
  /// unsupported) a planar or floating joint moves a frame of its chain that is only on /tf_static. With code
  /// unknown_frame, it says why the frame is not connected to the world frame. Empty: nothing is wrong.
  std::optional<Refusal> troubleOf(std::size_t frame) const;
  /// Returns the name of a frame that was never published, if this is why `frame` is not connected. Otherwise empty.
  const std::string& unknownFrame(std::size_t frame) const { return tree_.unknownFrame(frame); }

 private:
  Refusal notConnected(std::size_t frame) const;
  std::uint32_t contestedFrom(std::uint32_t number) const;

  const TfIntake& intake_;
  TfTree tree_;
  TickTime time_;
  std::string world_frame_;
  std::vector<std::string> frames_;
  std::vector<std::size_t> others_;  // frames that are not the world frame
  std::vector<Time> newest_;         // buffer of look(): the newest time of each chain that moves
  std::vector<FrameStamp> awaited_;
  bool first_ = true;  // whether there was no tick yet
  Time tick_time_{0}, tick_time_before_{0}, reading_{0}, reading_before_{0};
};

}  // namespace hgrid
