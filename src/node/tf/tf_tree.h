// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

#include <algorithm>
#include <optional>
#include <string>
#include <vector>

#include "node/tf/tf_intake.h"

namespace hgrid {

/// What is known of the chain of transforms from one frame to another.
struct ChainState {
  bool connected = false;  ///< there is a chain
  bool moves = false;      ///< a transform of the chain comes from /tf
  bool conflict = false;   ///< a frame of the chain comes on /tf and on /tf_static
  Time newest{0};          ///< moves: newest time at which the whole chain is known
  Time received{0};        ///< moves: least reading of the age clock when a newest transform came
  Time lead{0};            ///< moves: least lead of that clock over ROS time then
  double period = 0.0;     ///< [s] moves: longest of the measured periods in the chain
  /// Why the newest transform of a frame of the chain was refused; null: none was. Valid until the next take().
  const Refusal* refused = nullptr;
  std::uint32_t contested = TfIntake::kNone;  ///< a frame of the chain over which publishers fight

  /// Moves: the reading of the age clock at which the chain's pose of a time was 0 s old. That was at this time, but
  /// not later than when the data came.
  Time bornAt(Time time) const { return std::min(received, time + lead); }
};

/// Computes where the frames are that bodies follow, by multiplying transforms from the world frame to each.
///
/// The chains to all frames are laid out as one tree. A tick looks at each transform of the tree once, however many
/// chains lead through it. One thread, that of the TfIntake.
///
/// Usage per tick: plan() if stale(), look(), place().
class TfTree {
 public:
  explicit TfTree(const TfIntake& intake) : intake_(intake) {}

  /// Whether tf has learned of frames or parents since the last plan().
  bool stale() const { return revision_ != intake_.table().revision(); }
  /// Lays out the chains to `frames`. All other functions refer to a frame by its index in `frames`.
  void plan(const std::string& world_frame, const std::vector<std::string>& frames);
  /// Reads what is known of every chain. @param reading  of the age clock
  void look(Time reading);
  /// Computes where every frame is at `time`. It interpolates as tf2 does, but never between two transforms that do not
  /// continue each other.
  void place(Time time);

  const ChainState& state(std::size_t frame) const { return steps_[chains_[frame].step].state; }
  /// The frame's number in the TfIntake; kNone if it was never published.
  std::uint32_t numberOf(std::size_t frame) const { return chains_[frame].number; }
  /// If there is no chain: a frame that was never heard of; empty if all were.
  const std::string& unknownFrame(std::size_t frame) const { return chains_[frame].unknown; }
  /// Pose in the world at the time of place(); null if a transform of the chain is not known for that time.
  const FramePose* worldFrom(std::size_t frame) const {
    const Step& step = steps_[chains_[frame].step];
    return step.placed ? &step.world_from_frame : nullptr;
  }
  /// Pose in the world at another time than that of place(); empty if it is not known for that time.
  std::optional<FramePose> worldFrom(std::size_t frame, Time time) const { return along(chains_[frame].step, time); }

 private:
  /// From a frame to a neighbor farther from the world, which is a child or, above the world frame, the parent.
  struct Step {
    std::size_t from = 0;                   // step that ends where this one begins
    std::uint32_t moved = TfIntake::kNone;  // frame whose transform is crossed
    bool upwards = false;                   // towards the parent of `moved`
    bool placed = false;
    FramePose world_from_frame;
    ChainState state;
  };
  struct Chain {
    std::size_t step = 0;  // the last one
    std::uint32_t number = TfIntake::kNone;
    std::string unknown;
  };

  void addAncestors(std::size_t count);
  std::size_t lastStepTo(std::uint32_t frame);
  std::optional<FramePose> along(std::size_t step, Time time) const;

  static constexpr std::size_t kNowhere = 0, kWorld = 1;  // steps that lead to no frame, and to the world frame

  const TfIntake& intake_;
  std::uint64_t revision_ = ~std::uint64_t{0};
  std::vector<Step> steps_ = std::vector<Step>(2);  // each after the one it begins at
  std::vector<Chain> chains_;
  std::vector<std::uint32_t> above_;  // the world frame and its ancestors
  std::size_t ancestors_ = 0;         // of above_ that have steps
  std::vector<std::size_t> step_to_;  // by number of the frame; kNowhere: none yet
};

}  // namespace hgrid
