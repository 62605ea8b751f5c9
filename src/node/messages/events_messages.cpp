// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#include "node/messages/events_messages.h"

#include <hgrid_proximity/BodyState.h>
#include <hgrid_proximity/RuleOrigin.h>

#include <algorithm>
#include <chrono>
#include <limits>

#include "hgrid_proximity/distances/pair_meter.h"
#include "hgrid_proximity/explain/decided_rule.h"
#include "node/messages/pair_points.h"

namespace hgrid {
namespace {

/// Returns a rule as text for people: "robot/* obstacle/table: it is bolted on".
std::string textOf(const PairRule& rule) {
  return rule.first + " " + rule.second + (rule.reason.empty() ? "" : ": " + rule.reason);
}

// The share of ~distances/budget that the distances of events may use. Small, because ~pairs waits for them.
constexpr double kShareOfBudget = 0.2;

/// Returns whether a body of the event was removed from the world. Then the indices in the event are those of the
/// structure before the removal.
bool hasLostABody(const PairEvent& event, const Snapshot& snapshot) {
  return &snapshot.structureOf(event) != &snapshot.structure();
}

/// Returns the names of the bodies of the events from `first` to `last`, sorted, each once.
std::vector<std::string> namesOf(const Snapshot& snapshot, const PairEvent* first, const PairEvent* last) {
  std::vector<std::string> names;
  for (const PairEvent* event = first; event != last; ++event) {
    const BodyList& bodies = snapshot.structureOf(*event).bodies;
    names.push_back(bodies[event->first].name);
    names.push_back(bodies[event->second].name);
  }
  std::sort(names.begin(), names.end());
  names.erase(std::unique(names.begin(), names.end()), names.end());
  return names;
}

/// Measures the exact distances of events while there is time left.
class EventMeter {
 public:
  /// @param budget  [s] time for all measurements; 0: no limit
  EventMeter(const NarrowPhase& narrow_phase, const Snapshot& snapshot, double budget)
      : narrow_phase_(narrow_phase),
        snapshot_(snapshot),
        until_(budget > 0.0
                   ? Clock::now() + std::chrono::duration_cast<Clock::duration>(std::chrono::duration<double>(budget))
                   : Clock::time_point::max()) {}

  /// Returns the distance, the nearest points and the contact of the two bodies; all NaN if a body is gone or no time
  /// is left.
  PairDistance measure(const PairEvent& event) const {
    if (hasLostABody(event, snapshot_) || Clock::now() >= until_) return PairDistance{};
    constexpr double kFar = std::numeric_limits<double>::infinity();
    return measurePair(narrow_phase_, snapshot_, event.first, event.second, kFar);
  }

 private:
  using Clock = std::chrono::steady_clock;
  const NarrowPhase& narrow_phase_;
  const Snapshot& snapshot_;
  Clock::time_point until_;
};

/// Appends the margin, the states and the rule of an event. They are unknown if a body was removed.
void addState(const PairEvent& event, const Snapshot& snapshot, msg::Events& message) {
  const auto stateOf = [&](std::uint32_t body) { return static_cast<std::uint8_t>(snapshot.poses()[body].state); };
  if (hasLostABody(event, snapshot)) {
    message.margin.push_back(Proximity::kUnknown);
    message.first_state.push_back(msg::BodyState::UNPLACED);
    message.second_state.push_back(msg::BodyState::UNPLACED);
    message.rule_origin.push_back(msg::RuleOrigin::NONE);
    message.rule.emplace_back();
    return;
  }
  message.margin.push_back(snapshot.marginOf(event.first, event.second) + snapshot.growthOf(event.first, event.second));
  message.first_state.push_back(stateOf(event.first));
  message.second_state.push_back(stateOf(event.second));
  const PairRule rule = decidedRule(snapshot.structure(), event.first, event.second);
  message.rule_origin.push_back(static_cast<std::uint8_t>(rule.origin));
  message.rule.push_back(rule.origin == Origin::none ? std::string() : textOf(rule));
}

void add(const PairEvent& event, const Snapshot& snapshot, const PairDistance& measured, msg::Events& message) {
  const Structure& structure = snapshot.structureOf(event);
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
  const PairPoints points = pointsOf(measured);
  message.distance.push_back(measured.proximity.distance);
  message.point_on_first.push_back(toPoint(points.on_first));
  message.point_on_second.push_back(toPoint(points.on_second));
  message.contact_point.push_back(toPoint(measured.contact.point));
  message.normal.push_back(toVector(points.normal));
  message.depth.push_back(measured.contact.depth);
  addState(event, snapshot, message);
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
      add(*event, snapshot, meter.measure(*event), *message);
    }
    messages.push_back(message);
  }
  return messages;
}

}  // namespace hgrid
