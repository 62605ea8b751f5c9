// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#include "node/messages/world_state_message.h"

#include <hgrid_proximity/BodyState.h>

#include <algorithm>
#include <cmath>

#include "node/messages/source_messages.h"

namespace hgrid {

std::string truncationOf(const Snapshot& snapshot) {
  if (!snapshot.truncated()) return {};
  const std::string listed = std::to_string(snapshot.pairs().size());
  const bool more = snapshot.pairsFound() > snapshot.pairs().size();
  return "TRUNCATED: " + (more ? "more than " + listed + " pairs are near" : "the search for pairs reached its limit") +
         "; ~pairs lists only " + listed + " pairs (~limits/max_pairs)";
}

namespace {

const std::size_t kMostReasons = SceneOptions().max_reasons;  // that a message lists

/// Adds at most kMostReasons reasons why the world is not complete. The reasons that cause many others come first.
void addWorldReasons(const Tick& tick, msg::WorldState& world) {
  const Snapshot& snapshot = *tick.snapshot;
  world.reasons = tick.unplaced;
  world.reasons.insert(world.reasons.end(), snapshot.reasons().begin(), snapshot.reasons().end());
  world.reasons = firstOf(world.reasons, kMostReasons);
  world.reasons_total = static_cast<std::uint32_t>(tick.unplaced.size()) + snapshot.reasonsTotal();
  if (!snapshot.truncated()) return;
  world.reasons.push_back(truncationOf(snapshot));
  ++world.reasons_total;
}

}  // namespace

msg::WorldState worldState(const Tick& tick, double age_since) {
  const Params& params = tick.settings->params;
  msg::WorldState world;
  world.epoch = tick.epoch;
  world.config_hash = tick.settings->config_hash;
  world.valid_until = toRos(tick.made.ros + std::chrono::nanoseconds(std::llround(1e9 * params.valid_for)));
  world.unknown_space = static_cast<std::uint8_t>(params.map_unknown);
  if (!tick.snapshot) {
    world.reasons = firstOf(tick.not_ready, kMostReasons);
    world.reasons_total = static_cast<std::uint32_t>(tick.not_ready.size());
    world.worst_state = msg::BodyState::UNPLACED;
    for (const msg::SourceStatus& source : sourcesOf(tick, params)) world.incomplete.push_back(source.name);
    world.incomplete_total = static_cast<std::uint32_t>(world.incomplete.size());
    world.incomplete = firstOf(world.incomplete, static_cast<std::size_t>(params.max_listed));
    return world;
  }
  const Snapshot& snapshot = *tick.snapshot;
  world.stamp = world.history_begin = toRos(snapshot.stamp());
  if (tick.history.ticks > 0 && tick.history.epoch == tick.epoch) {
    world.history_begin = toRos(std::min(tick.history.begin, snapshot.stamp()));
  }
  world.sequence = snapshot.sequence();
  world.bodies_revision = snapshot.structure().revision;
  world.complete = snapshot.complete() && !snapshot.truncated();
  world.incomplete = firstOf(snapshot.incompleteSources(), static_cast<std::size_t>(params.max_listed));
  world.incomplete_total = static_cast<std::uint32_t>(snapshot.incompleteSources().size());
  addWorldReasons(tick, world);
  world.worst_state = static_cast<std::uint8_t>(snapshot.worstState());
  world.last_event = snapshot.lastEvent();
  world.max_age = snapshot.maxAge() > 0.0 ? snapshot.maxAge() + age_since : 0.0;
  return world;
}

}  // namespace hgrid
