// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

#include <algorithm>
#include <optional>
#include <string>
#include <vector>

#include "node/tf/tf_intake.h"
#include "node/time/freshness.h"

namespace hgrid {

/// What is known about the chain of transforms from the world frame to another frame.
struct ChainState {
  bool connected = false;  ///< whether there is a chain
  bool moves = false;      ///< whether a transform of the chain is published on /tf
  bool conflict = false;   ///< whether a frame of the chain is published on both /tf and /tf_static

  // The next five values are set only if the chain moves. Each combines the values of all moving frames of the chain.
  Time newest{0};       ///< newest time at which the whole chain is known
  Time received{0};     ///< least FramePace::received()
  Time lead{0};         ///< least FramePace::lead()
  double period = 0.0;  ///< [s] longest FramePace::period()
  /// Worst state of a moving frame. Each is judged by its own age and its own period, so that a slow frame of the chain
  /// does not hide that a fast one has stopped.
  Freshness worst = Freshness::fresh;

  /// Why the newest transform of a frame of the chain was refused. Null: none was refused. Valid until the
  /// TfIntake changes.
  const Refusal* refused = nullptr;
  std::uint32_t contested = TfIntake::kNone;  ///< number of a contested frame of the chain, or kNone
  /// Number of the first frame of the chain whose static pose is not used, or kNone: see TfIntake::setFree(). Then
  /// the chain is not connected.
  std::uint32_t free_but_static = TfIntake::kNone;

  /// Converts a time to the AgeClock: at the returned reading, the chain's pose at `time` had the age 0. The reading is
  /// never later than the arrival of the data. Call this only if the chain moves.
  Time bornAt(Time time) const { return std::min(received, time + lead); }
};

/// Computes the poses of the frames that bodies follow: multiplies the transforms from the world frame to each frame.
///
/// The chains to all frames form one tree. A tick reads each transform of the tree once, even if many chains contain
/// it. Only the tick thread may use this class.
///
/// Each tick calls plan() if stale(), then look(), then place().
class TfTree {
 public:
  explicit TfTree(const TfIntake& intake, const AgeLimits& limits = {}) : intake_(intake), limits_(limits) {}

  /// Whether a new frame or a new parent has appeared in tf since the last plan().
  bool stale() const { return revision_ != intake_.table().revision(); }
  /// Finds the chains of transforms to `frames`. All other functions refer to a frame by its index in `frames`.
  void plan(const std::string& world_frame, const std::vector<std::string>& frames);
  /// Updates the state of every chain. @param reading  reading of the age clock in this tick
  void look(Time reading);
  /// Computes the pose of every frame at `time`. Interpolates as tf2 does, but never across a seam.
  void place(Time time);

  /// Replaces `frames` with the moving frames of all chains that move and are known until `since` or later.
  void listMoving(Time since, std::vector<FrameStamp>& frames);

  /// Whether the frame is the world frame itself, so that no transform can move it.
  bool isWorld(std::size_t frame) const { return chains_[frame].step == kWorld; }
  const ChainState& state(std::size_t frame) const { return steps_[chains_[frame].step].state; }
  /// Returns the frame's number in the TfIntake, or kNone if it was never published.
  std::uint32_t numberOf(std::size_t frame) const { return chains_[frame].number; }
  /// Returns the name of a frame that was never published, if this is why there is no chain. Otherwise empty.
  const std::string& unknownFrame(std::size_t frame) const { return chains_[frame].unknown; }
  /// Returns the pose in the world at the time of place(). Null: a transform of the chain is not known at that time.
  const FramePose* worldFrom(std::size_t frame) const {
    const Step& step = steps_[chains_[frame].step];
    return step.placed ? &step.world_from_frame : nullptr;
  }
  /// Returns the pose in the world at any time. Empty: the pose is not known at that time.
  std::optional<FramePose> worldFrom(std::size_t frame, Time time) const { return along(chains_[frame].step, time); }

 private:
  /// A step from a frame to its neighbor that is farther from the world frame. The neighbor is a child. Only on the way
  /// from the world frame to its ancestors, the neighbor is the parent.
  struct Step {
    std::size_t from = 0;                   // index of the previous step, which ends where this step begins
    std::uint32_t moved = TfIntake::kNone;  // number of the frame whose transform this step uses
    bool upwards = false;                   // whether the step goes from `moved` to its parent
    bool placed = false;                    // whether world_from_frame is known
    bool listed = false;                    // buffer of listMoving(): whether a listed chain contains this step
    FramePose world_from_frame;
    ChainState state;
  };
  struct Chain {
    std::size_t step = 0;  // index of the last step of the chain
    std::uint32_t number = TfIntake::kNone;
    std::string unknown;
  };

  void addAncestors(std::size_t count);
  std::size_t lastStepTo(std::uint32_t frame);
  std::optional<FramePose> along(std::size_t step, Time time) const;

  static constexpr std::size_t kNowhere = 0, kWorld = 1;  // index for "no step"; index of the step to the world frame

  const TfIntake& intake_;
  const AgeLimits limits_;
  std::uint64_t revision_ = ~std::uint64_t{0};
  std::vector<Step> steps_ = std::vector<Step>(2);  // each step comes after its `from`
  std::vector<Chain> chains_;
  std::vector<std::size_t> ends_;     // last steps of the chains that are not the world frame; some occur repeatedly
  std::vector<std::uint32_t> above_;  // the world frame and its ancestors
  std::size_t ancestors_ = 0;         // number of ancestors in above_ that have a step
  std::vector<std::size_t> step_to_;  // step that leads to a frame, by frame number; kNowhere: none yet
};

}  // namespace hgrid
