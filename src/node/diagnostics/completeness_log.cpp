// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#include "node/diagnostics/completeness_log.h"

#include <ros/console.h>

#include <algorithm>
#include <tuple>
#include <utility>

#include "node/messages/to_messages.h"
#include "node/messages/world_state_message.h"

namespace hgrid {
namespace {

/// Returns the worst reason, and how many others there are.
std::string reasonOf(const Tick& tick) {
  if (tick.snapshot && tick.snapshot->complete()) return truncationOf(*tick.snapshot);
  const std::size_t all = tick.snapshot ? tick.unplaced.size() + tick.snapshot->reasonsTotal() : tick.not_ready.size();
  const std::string& worst = !tick.snapshot          ? tick.not_ready.front()
                             : tick.unplaced.empty() ? tick.snapshot->reasons().front()
                                                     : tick.unplaced.front();
  return all > 1 ? worst + " (and " + std::to_string(all - 1) + " more in ~status)" : worst;
}

}  // namespace

void CompletenessLog::log(const Tick& tick) {
  const std::optional<Line> line = next(tick);
  if (!line) return;
  if (line->complete) {
    ROS_INFO("%s", line->text.c_str());
  } else {
    ROS_WARN("%s", line->text.c_str());
  }
}

std::optional<CompletenessLog::Line> CompletenessLog::next(const Tick& tick) {
  State state = stateOf(tick);
  if (isKnown(state)) return std::nullopt;
  if (!state.complete && tick.made.steady < quiet_until_) return std::nullopt;
  known_ = std::move(state);
  if (!known_->complete) {
    quiet_until_ = tick.made.steady + kPause;
    return Line{false, "The world is not complete: " + reasonOf(tick)};
  }
  return Line{true, "The world is complete: " + std::to_string(tick.snapshot->poses().size()) + " bodies in frame '" +
                        tick.world_frame + "'."};
}

CompletenessLog::State CompletenessLog::stateOf(const Tick& tick) {
  State state;
  state.has_world = tick.snapshot != nullptr;
  if (!state.has_world) {
    state.not_ready = tick.not_ready.size();
    state.waits_for = tick.waits_for;
    return state;
  }
  const Snapshot& snapshot = *tick.snapshot;
  state.truncated = snapshot.truncated();
  state.complete = snapshot.complete() && !state.truncated;
  if (snapshot.complete()) return state;  // in a complete world, states of bodies do not matter
  state.worst = std::max(state.worst, snapshot.worstState());
  state.sources = snapshot.incompleteSources();
  return state;
}

bool CompletenessLog::isKnown(const State& state) const {
  const auto tie = [](const State& s) {
    return std::tie(s.complete, s.has_world, s.truncated, s.worst, s.not_ready, s.waits_for, s.sources);
  };
  return known_ && tie(*known_) == tie(state);
}

}  // namespace hgrid
