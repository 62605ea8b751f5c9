// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#include "node/tf/frame_poses.h"

#include <algorithm>
#include <utility>

namespace hgrid {

void FramePoses::plan(const std::string& world_frame, std::vector<std::string> frames) {
  world_frame_ = world_frame;
  frames_ = std::move(frames);
  tree_.plan(world_frame, frames_);
  others_.clear();
  for (std::size_t i = 0; i < frames_.size(); ++i) {
    if (!isWorld(i)) others_.push_back(i);
  }
}

void FramePoses::look(const Moment& now) {
  const Time last_reading = reading_, last_tick_time = tick_time_;
  reading_ = intake_.ages().read(now);
  reading_before_ = first_ ? reading_ : last_reading;
  tree_.look(reading_);
  newest_.clear();
  for (const std::size_t i : others_) {
    const ChainState& state = chain(i);
    if (state.connected && state.moves) newest_.push_back(state.newest);
  }
  tick_time_ = time_.choose(newest_, now.ros);
  tick_time_before_ = first_ ? tick_time_ : std::min(last_tick_time, tick_time_);
  first_ = false;
  tree_.listMoving(time_.keepsUpFrom(), awaited_);
  tree_.place(tick_time_);
}

std::optional<FramePoses::Found> FramePoses::find(std::size_t frame, const KeptPose& in_use) const {
  const ChainState& state = chain(frame);
  if (!state.connected) return std::nullopt;
  if (const FramePose* pose = tree_.worldFrom(frame)) return Found{*pose, tick_time_, state.bornAt(tick_time_)};
  // A frame that lags behind gets the pose of its own newest time. All transforms of its chain are taken at that time.
  if (in_use.exists() && (state.newest >= tick_time_ || state.newest < in_use.stamp())) return std::nullopt;
  const std::optional<FramePose> pose = tree_.worldFrom(frame, state.newest);
  if (!pose) return std::nullopt;
  return Found{*pose, state.newest, state.bornAt(state.newest)};
}

std::optional<Refusal> FramePoses::troubleOf(std::size_t frame) const {
  const ChainState& state = chain(frame);
  const std::uint32_t contested = state.connected ? state.contested : contestedFrom(tree_.numberOf(frame));
  if (contested != TfIntake::kNone) return Refusal(Code::conflict, intake_.claims().sentence(contested));
  if (state.refused != nullptr) return *state.refused;
  if (state.free_but_static != TfIntake::kNone)
    return Refusal(Code::unsupported, freeButStatic(intake_.table().name(state.free_but_static)));
  if (!state.connected) return notConnected(frame);
  return std::nullopt;
}

Refusal FramePoses::notConnected(std::size_t frame) const {
  const std::string& unknown = tree_.unknownFrame(frame);
  return Refusal(Code::unknown_frame,
                 "frame '" + frames_[frame] + "' is not connected to '" + world_frame_ + "'" +
                     (unknown.empty() ? std::string(": there is no chain of transforms between them now")
                                      : ": frame '" + unknown + "' was never published"));
}

/// Returns the first contested frame among a frame and its ancestors. Used if the frame is not connected to the world
/// frame. kNone: there is none.
std::uint32_t FramePoses::contestedFrom(std::uint32_t number) const {
  for (std::size_t i = 0; i < FrameTable::kLongestChain && number != TfIntake::kNone; ++i) {
    if (intake_.isContested(number, reading_)) return number;
    number = intake_.table().parent(number);
  }
  return TfIntake::kNone;
}

}  // namespace hgrid
