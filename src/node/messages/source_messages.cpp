// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#include "node/messages/source_messages.h"

#include <hgrid_proximity/BodyState.h>
#include <hgrid_proximity/WorldState.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <string>

#include "hgrid_proximity/bodies/name.h"

namespace hgrid {
namespace {

using Sources = std::map<std::string, msg::SourceStatus>;

/// Returns the entry of a source. If there is none yet, adds one that says that nothing is known about the source.
msg::SourceStatus& entryOf(Sources& sources, const std::string& name) {
  const auto known = sources.emplace(name, msg::SourceStatus());
  msg::SourceStatus& source = known.first->second;
  if (known.second) {
    source.name = name;
    source.state = msg::BodyState::UNPLACED;
    source.age = std::nan("");
  }
  return source;
}

void addExpected(const Tick& tick, const Params& params, Sources& sources) {
  for (const std::string& robot : tick.models->expected) entryOf(sources, robot);
  if (!params.obstacles.empty()) entryOf(sources, "obstacle");
  for (const MapParams& map : params.maps) entryOf(sources, joined("map", map.name));
  for (const CloudParams& cloud : params.clouds) entryOf(sources, joined("cloud", cloud.name));
  for (const TrackerParams& tracker : params.trackers) entryOf(sources, joined("track", tracker.name));
}

void addBodies(const Snapshot& snapshot, Sources& sources) {
  const Structure& structure = snapshot.structure();
  std::vector<msg::SourceStatus*> entries;
  for (const std::string& source : structure.sources) {
    entries.push_back(&entryOf(sources, source));
    entries.back()->state = msg::BodyState::FRESH;
  }
  std::vector<std::uint32_t> bodies(entries.size(), 0), placed;
  for (const std::uint32_t source : structure.source_of) ++bodies[source];
  placed = bodies;
  // Reading the poses of all bodies would take longer than the rest of a tick in which few of them move.
  for (const std::uint32_t body : snapshot.watched()) {
    msg::SourceStatus& source = *entries[structure.source_of[body]];
    const BodyPose& pose = snapshot.poses()[body];
    source.state = std::max(source.state, static_cast<std::uint8_t>(pose.state));
    if (pose.state == Freshness::unplaced) {
      --placed[structure.source_of[body]];
    } else if (pose.age > source.age || std::isnan(source.age)) {
      source.age = pose.age;
    }
  }
  for (std::size_t i = 0; i < entries.size(); ++i) {
    entries[i]->bodies = bodies[i];
    if (placed[i] > 0 && std::isnan(entries[i]->age)) entries[i]->age = 0.0;
  }
}

void addReasons(const Snapshot& snapshot, Sources& sources) {
  for (auto& source : sources) source.second.complete = true;
  for (const std::string& name : snapshot.incompleteSources()) {
    msg::SourceStatus& source = entryOf(sources, name);
    source.complete = false;
    source.reason = snapshot.reasonOf(name);
  }
}

}  // namespace

std::vector<msg::SourceStatus> sourcesOf(const Tick& tick, const Params& params) {
  Sources sources;
  addExpected(tick, params, sources);
  if (tick.snapshot) {
    addBodies(*tick.snapshot, sources);
    addReasons(*tick.snapshot, sources);
  }
  std::vector<msg::SourceStatus> list;
  for (const auto& source : sources) list.push_back(source.second);
  return list;
}

}  // namespace hgrid
