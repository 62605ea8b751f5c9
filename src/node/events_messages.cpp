// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#include "events_messages.h"

#include <algorithm>
#include <cmath>

namespace hgrid {
namespace {

/// Names of the bodies of some events, sorted, each once.
std::vector<std::string> namesOf(const Snapshot& snapshot, const PairEvent* first, const PairEvent* last) {
  std::vector<std::string> names;
  for (const PairEvent* event = first; event != last; ++event) {
    const std::vector<Body>& bodies = snapshot.structureOf(*event).bodies;
    names.push_back(bodies[event->first].name);
    names.push_back(bodies[event->second].name);
  }
  std::sort(names.begin(), names.end());
  names.erase(std::unique(names.begin(), names.end()), names.end());
  return names;
}

void add(const PairEvent& event, const Structure& structure, msg::Events& message) {
  const auto indexOf = [&](std::uint32_t body) {
    const std::string& name = structure.bodies[body].name;
    const auto found = std::lower_bound(message.names.begin(), message.names.end(), name);
    return static_cast<std::uint32_t>(found - message.names.begin());
  };
  message.number.push_back(event.number);
  message.kind.push_back(static_cast<std::uint8_t>(event.kind));
  message.cause.push_back(static_cast<std::uint8_t>(event.cause));
  message.first.push_back(indexOf(event.first));
  message.second.push_back(indexOf(event.second));
  message.since.push_back(toRos(event.since));
  message.gap.push_back(event.gap);
  message.distance.push_back(std::nan(""));
}

}  // namespace

std::vector<boost::shared_ptr<msg::Events>> eventsMessages(const Tick& tick, const msg::WorldState& world,
                                                           const Params& params) {
  std::vector<boost::shared_ptr<msg::Events>> messages;
  if (!tick.snapshot) return messages;
  const Snapshot& snapshot = *tick.snapshot;
  const std::vector<PairEvent>& events = snapshot.events();
  const std::size_t most = static_cast<std::size_t>(params.max_events);
  for (std::size_t begin = 0; begin < events.size(); begin += most) {
    const PairEvent* const first = events.data() + begin;
    const PairEvent* const last = first + std::min(most, events.size() - begin);
    const auto message = boost::make_shared<msg::Events>();
    message->header = headerOf(tick);
    message->world = world;
    message->world.last_event = (last - 1)->number;
    message->names = namesOf(snapshot, first, last);
    for (const PairEvent* event = first; event != last; ++event) add(*event, snapshot.structureOf(*event), *message);
    messages.push_back(message);
  }
  return messages;
}

}  // namespace hgrid
