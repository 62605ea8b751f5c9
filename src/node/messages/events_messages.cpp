// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#include "node/messages/events_messages.h"

#include <algorithm>
#include <chrono>
#include <limits>

#include "hgrid_proximity/distances/pair_meter.h"

namespace hgrid {
namespace {

constexpr double kShareOfBudget = 0.2;  // of ~distances/budget: ~pairs waits for it

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

/// Exact distances of events, as long as there is time.
class EventMeter {
 public:
  /// @param budget  [s] 0: as long as it takes
  EventMeter(const NarrowPhase& narrow_phase, const Snapshot& snapshot, double budget)
      : narrow_phase_(narrow_phase),
        snapshot_(snapshot),
        until_(budget > 0.0
                   ? Clock::now() + std::chrono::duration_cast<Clock::duration>(std::chrono::duration<double>(budget))
                   : Clock::time_point::max()) {}

  /// [m] NaN if a body is gone, or no time is left.
  double distanceOf(const PairEvent& event) const {
    if (&snapshot_.structureOf(event) != &snapshot_.structure() || Clock::now() >= until_) return Proximity::kUnknown;
    constexpr double kFar = std::numeric_limits<double>::infinity();
    return measurePair(narrow_phase_, snapshot_, event.first, event.second, kFar).proximity.distance;
  }

 private:
  using Clock = std::chrono::steady_clock;
  const NarrowPhase& narrow_phase_;
  const Snapshot& snapshot_;
  Clock::time_point until_;
};

void add(const PairEvent& event, const Structure& structure, double distance, msg::Events& message) {
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
  message.distance.push_back(distance);
}

}  // namespace

std::vector<boost::shared_ptr<msg::Events>> eventsMessages(const Tick& tick, const msg::WorldState& world,
                                                           const Params& params, const NarrowPhase& narrow_phase) {
  std::vector<boost::shared_ptr<msg::Events>> messages;
  if (!tick.snapshot) return messages;
  const Snapshot& snapshot = *tick.snapshot;
  const std::vector<PairEvent>& events = snapshot.events();
  const EventMeter meter(narrow_phase, snapshot, kShareOfBudget * params.distances_budget);
  const std::size_t most = static_cast<std::size_t>(params.max_events);
  for (std::size_t begin = 0; begin < events.size(); begin += most) {
    const PairEvent* const first = events.data() + begin;
    const PairEvent* const last = first + std::min(most, events.size() - begin);
    const auto message = boost::make_shared<msg::Events>();
    message->header = headerOf(tick);
    message->world = world;
    message->world.last_event = (last - 1)->number;
    message->names = namesOf(snapshot, first, last);
    for (const PairEvent* event = first; event != last; ++event) {
      add(*event, snapshot.structureOf(*event), meter.distanceOf(*event), *message);
    }
    messages.push_back(message);
  }
  return messages;
}

}  // namespace hgrid
