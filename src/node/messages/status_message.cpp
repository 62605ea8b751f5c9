// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#include "node/messages/status_message.h"

#include <algorithm>

#include "node/messages/interface_version.h"
#include "node/messages/source_messages.h"

namespace hgrid {
namespace {

msg::SelfPairs toMsg(const std::string& robot, const SelfPairs& counts) {
  msg::SelfPairs message;
  message.robot = robot;
  message.links = static_cast<std::uint32_t>(counts.links);
  message.pairs = static_cast<std::uint32_t>(counts.pairs);
  message.rigid = static_cast<std::uint32_t>(counts.rigid);
  message.adjacent = static_cast<std::uint32_t>(counts.adjacent);
  message.srdf = static_cast<std::uint32_t>(counts.srdf);
  return message;
}

/// Adds the lists of names and sentences. `most` limits the length of each.
void addLists(const Tick& tick, std::size_t most, msg::Status& message) {
  std::vector<std::string> not_ready = tick.not_ready;
  not_ready.insert(not_ready.end(), tick.unplaced.begin(), tick.unplaced.end());
  message.not_ready = shortened(not_ready, most);
  message.missing_frames = shortened(tick.missing_frames, most);
  message.contested_frames = shortened(tick.contested_frames, most);
  message.absent_robots = shortened(tick.models->absent, most);
  message.uncovered = shortened(tick.models->uncovered, most);
  message.waived = shortened(tick.models->waived, most);
  message.without_collision = shortened(tick.models->without_collision, most);
  message.uses_visual = shortened(tick.models->uses_visual, most);
  message.model_warnings = shortened(tick.models->warnings, most);
}

/// Adds the publishers whose stamps are constantly early or late, at most `most`.
void addClockOffsets(const Tick& tick, std::size_t most, msg::Status& message) {
  for (const ClockOffset& offset : tick.clock_offsets) {
    if (message.clock_offsets.size() >= most) break;
    msg::ClockOffset entry;
    entry.publisher = offset.publisher;
    entry.offset = offset.offset;
    message.clock_offsets.push_back(entry);
  }
}

}  // namespace

msg::Status statusMessage(const Tick& tick, const msg::WorldState& world, const Params& params, const Ledger& ledger,
                          const Stopwatch& stopwatch) {
  msg::Status message;
  message.header = headerOf(tick);
  message.world = world;
  message.node_version = HGRID_PROXIMITY_VERSION;
  message.interface_version = kInterfaceVersion;
  message.made = toRos(tick.made.ros);
  message.sources = sourcesOf(tick, params);
  message.sources_total = static_cast<std::uint32_t>(message.sources.size());
  message.sources.resize(std::min(message.sources.size(), static_cast<std::size_t>(params.max_listed)));
  message.bodies_total = static_cast<std::uint32_t>(tick.troubles.size());
  for (const BodyTrouble& trouble : tick.troubles) {
    if (message.bodies.size() >= static_cast<std::size_t>(params.max_listed)) break;
    msg::BodyStatus body;
    body.name = trouble.name;
    body.frame = trouble.frame;
    body.state = static_cast<std::uint8_t>(trouble.state);
    body.age = trouble.age;
    body.stamp = toRos(trouble.stamp);
    body.code = toMsg(trouble.code, trouble.sentence);
    message.bodies.push_back(body);
  }
  addLists(tick, static_cast<std::size_t>(params.max_listed), message);
  addClockOffsets(tick, static_cast<std::size_t>(params.max_listed), message);
  for (const auto& robot : tick.models->self_pairs) message.self_pairs.push_back(toMsg(robot.first, robot.second));
  message.robots = static_cast<std::uint32_t>(tick.models->robots);
  if (tick.snapshot) {
    const Snapshot& snapshot = *tick.snapshot;
    message.body_count = static_cast<std::uint32_t>(snapshot.poses().size());
    message.shape_count = static_cast<std::uint32_t>(snapshot.boxes().size());
    message.pair_count = static_cast<std::uint32_t>(snapshot.pairs().size());
    for (const BroadPhaseLevel& level : snapshot.broadPhase().levels()) {
      message.level_count.push_back(static_cast<std::uint32_t>(level.boxes));
      if (std::isfinite(level.edge)) message.level_edge.push_back(level.edge);
    }
  }
  for (const auto& counter : ledger.counters()) {
    message.counters.emplace_back();
    message.counters.back().name = counter.first;
    message.counters.back().value = counter.second;
  }
  const auto gauge = [&](const std::string& name, double value) {
    message.gauges.emplace_back();
    message.gauges.back().name = name;
    message.gauges.back().value = value;
  };
  if (tick.snapshot) {
    const Structure& structure = tick.snapshot->structure();
    for (const std::uint32_t map : structure.maps) {  // sorted by name
      const auto cells = tick.snapshot->cellsOf(map);
      gauge("cells." + structure.bodies[map].name, cells ? static_cast<double>(cells->grid->size()) : 0.0);
    }
  }
  gauge("history.bytes", static_cast<double>(tick.history.bytes));
  gauge("history.ticks", static_cast<double>(tick.history.ticks));
  gauge("tf.frames", static_cast<double>(tick.frames));
  for (const auto& part : stopwatch.summaries()) {
    msg::Timing timing;
    timing.name = part.first;
    timing.last = part.second.last;
    timing.median = part.second.median;
    timing.p99 = part.second.p99;
    timing.max = part.second.max;
    message.timings.push_back(timing);
  }
  message.timing_ticks = static_cast<std::uint32_t>(stopwatch.ticks());
  return message;
}

}  // namespace hgrid
