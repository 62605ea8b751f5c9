// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#include "node/tf/tf_tree.h"

#include <algorithm>

namespace hgrid {
namespace {

/// Returns the age [s] of the newest transform of a frame: as ChainState::bornAt(), but of this frame alone.
double ageOf(const FramePace& pace, Time stamp, Time reading) {
  return seconds(reading - std::min(pace.received(), stamp + pace.lead()));
}

/// Updates the state of a chain that is extended by the transform of one more frame.
void extend(ChainState& state, const TfIntake& intake, std::uint32_t number, bool upwards, Time reading,
            const AgeLimits& limits) {
  const TfIntake::Frame& frame = intake.frame(number);
  if (frame.refused && (upwards || state.refused == nullptr)) state.refused = intake.refusal(number);
  if (frame.hasConflict()) state.conflict = true;
  if (frame.claimed && intake.isContested(number, reading)) state.contested = number;
  if (intake.isFreeButStatic(number)) {
    state.connected = false;
    if (state.free_but_static == TfIntake::kNone) state.free_but_static = number;
  }
  const FrameHistory& history = intake.history(number);
  if (!history.moves()) return;
  const Time stamp = history.newest().stamp;
  if (stamp.count() == 0) state.connected = false;  // no transform has arrived since the clock jumped
  state.newest = state.moves ? std::min(state.newest, stamp) : stamp;
  state.received = state.moves ? std::min(state.received, frame.pace.received()) : frame.pace.received();
  state.lead = state.moves ? std::min(state.lead, frame.pace.lead()) : frame.pace.lead();
  state.period = std::max(state.period, frame.pace.period());
  state.worst = std::max(state.worst, freshnessOf(ageOf(frame.pace, stamp, reading), frame.pace.period(), limits));
  state.moves = true;
}

}  // namespace

/// Adds the steps from the world frame up to its first `count` ancestors.
void TfTree::addAncestors(std::size_t count) {
  for (; ancestors_ < count; ++ancestors_) {
    Step step;
    step.moved = above_[ancestors_];
    step.from = step_to_[step.moved];
    step.upwards = true;
    step_to_[above_[ancestors_ + 1]] = steps_.size();
    steps_.push_back(step);
  }
}

/// Returns the last step of the chain to a frame. Follows the parents of the frame up to one that already has a step,
/// then adds the missing steps downwards. kNowhere: there is no chain.
std::size_t TfTree::lastStepTo(std::uint32_t frame) {
  std::vector<std::uint32_t> down;
  while (step_to_[frame] == kNowhere) {
    const auto ancestor = std::find(above_.begin(), above_.end(), frame);
    if (ancestor != above_.end()) {
      addAncestors(static_cast<std::size_t>(ancestor - above_.begin()));
      break;
    }
    const std::uint32_t parent = intake_.table().parent(frame);
    if (parent == TfIntake::kNone || down.size() >= FrameTable::kLongestChain) return kNowhere;
    down.push_back(frame);
    frame = parent;
  }
  for (auto next = down.rbegin(); next != down.rend(); ++next) {
    Step step;
    step.moved = *next;
    step.from = step_to_[frame];
    frame = *next;
    step_to_[frame] = steps_.size();
    steps_.push_back(step);
  }
  return step_to_[frame];
}

void TfTree::plan(const std::string& world_frame, const std::vector<std::string>& frames) {
  revision_ = intake_.table().revision();
  steps_.assign(2, Step{});
  steps_[kWorld].state.connected = steps_[kWorld].placed = true;
  step_to_.assign(intake_.table().size(), kNowhere);
  above_.clear();
  ancestors_ = 0;
  const std::uint32_t world = intake_.table().find(world_frame);
  for (std::uint32_t frame = world; frame != TfIntake::kNone; frame = intake_.table().parent(frame)) {
    if (std::find(above_.begin(), above_.end(), frame) != above_.end()) break;
    above_.push_back(frame);
  }
  if (world != TfIntake::kNone) step_to_[world] = kWorld;

  chains_.clear();
  ends_.clear();
  for (const std::string& frame : frames) {
    const std::uint32_t number = intake_.table().find(frame);
    Chain chain;
    chain.number = number;
    if (frame == world_frame) {
      chain.step = kWorld;
    } else if (number != TfIntake::kNone) {
      chain.step = lastStepTo(number);
    }
    if (chain.step == kNowhere && world == TfIntake::kNone) chain.unknown = world_frame;
    if (chain.step == kNowhere && number == TfIntake::kNone) chain.unknown = frame;
    if (chain.step > kWorld) ends_.push_back(chain.step);
    chains_.push_back(std::move(chain));
  }
}

void TfTree::look(Time reading) {
  for (std::size_t i = 2; i < steps_.size(); ++i) {
    Step& step = steps_[i];
    step.state = steps_[step.from].state;
    extend(step.state, intake_, step.moved, step.upwards, reading, limits_);
  }
}

void TfTree::place(Time time) {
  for (std::size_t i = 2; i < steps_.size(); ++i) {
    Step& step = steps_[i];
    const Step& from = steps_[step.from];
    step.placed = from.placed && step.state.connected;
    if (!step.placed) continue;
    const std::optional<FramePose> pose = intake_.history(step.moved).at(time);
    step.placed = pose.has_value();
    if (pose) step.world_from_frame = from.world_from_frame * (step.upwards ? pose->inverse() : *pose);
  }
}

void TfTree::listMoving(Time since, std::vector<FrameStamp>& frames) {
  frames.clear();
  for (Step& step : steps_) step.listed = false;
  for (const std::size_t end : ends_) {
    const ChainState& state = steps_[end].state;
    if (state.connected && state.moves && state.newest >= since) steps_[end].listed = true;
  }
  for (std::size_t i = steps_.size() - 1; i > kWorld; --i) {  // each step comes after its `from`
    const Step& step = steps_[i];
    if (!step.listed) continue;
    steps_[step.from].listed = true;
    const FrameHistory& history = intake_.history(step.moved);
    if (history.moves()) frames.push_back({step.moved, history.newest().stamp});
  }
}

std::optional<FramePose> TfTree::along(std::size_t number, Time time) const {
  if (number == kWorld) return FramePose{};
  const Step& step = steps_[number];
  if (!step.state.connected) return std::nullopt;
  const std::optional<FramePose> from = along(step.from, time);
  if (!from) return std::nullopt;
  const std::optional<FramePose> pose = intake_.history(step.moved).at(time);
  if (!pose) return std::nullopt;
  return *from * (step.upwards ? pose->inverse() : *pose);
}

}  // namespace hgrid
