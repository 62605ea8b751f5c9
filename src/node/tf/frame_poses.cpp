// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#include "node/tf/frame_poses.h"

namespace hgrid {
namespace {

constexpr int kLongestWalk = 1000;  // frames

}  // namespace

void FramePoses::plan(const std::string& world_frame, const std::vector<std::string>& frames) {
  world_frame_ = world_frame;
  frames_ = frames;
  ways_.plan(world_frame, frames);
}

void FramePoses::look(const Moment& now) {
  reading_before_ = reading_;
  tick_time_before_ = tick_time_;
  reading_ = intake_.ages().read(now);
  ways_.look(reading_);
  newest_.clear();
  for (std::size_t i = 0; i < frames_.size(); ++i) {
    const ChainState& state = chain(i);
    if (state.connected && state.moves) newest_.push_back(state.newest);
  }
  tick_time_ = time_.choose(newest_, now.ros);
  ways_.place(tick_time_);
}

std::optional<FramePoses::Found> FramePoses::find(std::size_t frame, const KeptPose& in_use) const {
  const ChainState& state = chain(frame);
  if (!state.connected) return std::nullopt;
  if (const FramePose* pose = ways_.worldFrom(frame)) return Found{*pose, tick_time_, state.bornAt(tick_time_)};
  // What lags stays where it was as a whole: its way is taken at its own time, not at that of the others.
  if (in_use.exists() && (state.newest >= tick_time_ || state.newest < in_use.stamp())) return std::nullopt;
  const std::optional<FramePose> pose = ways_.worldFrom(frame, state.newest);
  if (!pose) return std::nullopt;
  return Found{*pose, state.newest, state.bornAt(state.newest)};
}

std::optional<Refusal> FramePoses::troubleOf(std::size_t frame) const {
  const ChainState& state = chain(frame);
  const std::uint32_t contested = state.connected ? state.contested : contestedFrom(ways_.numberOf(frame));
  if (contested != TfIntake::kNone) return Refusal(Code::conflict, intake_.claims().sentence(contested));
  if (state.refused != nullptr) return *state.refused;
  if (!state.connected) return noWay(frame);
  return std::nullopt;
}

Refusal FramePoses::noWay(std::size_t frame) const {
  const std::string& unknown = ways_.unknownFrame(frame);
  return Refusal(Code::unknown_frame,
                 "frame '" + frames_[frame] + "' is not connected to '" + world_frame_ + "'" +
                     (unknown.empty() ? std::string(": there is no way of transforms between them now")
                                      : ": frame '" + unknown + "' was never published"));
}

/// The first contested frame on the way up from a frame that has no way to the world frame; kNone if there is none.
std::uint32_t FramePoses::contestedFrom(std::uint32_t number) const {
  for (int i = 0; i < kLongestWalk && number != TfIntake::kNone; ++i) {
    if (intake_.isContested(number, reading_)) return number;
    number = intake_.frame(number).parent;
  }
  return TfIntake::kNone;
}

}  // namespace hgrid
