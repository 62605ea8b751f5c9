// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

#include <string>
#include <vector>

#include "hgrid_proximity/world/snapshot.h"

namespace hgrid {
namespace test {

inline const char* nameOf(EventKind kind) { return kind == EventKind::begin ? "BEGIN" : "END"; }

inline const char* nameOf(EventCause cause) {
  static constexpr const char* kNames[] = {"MOVED", "BODIES", "FILTER", "STALENESS", "EPOCH"};
  return kNames[static_cast<int>(cause)];
}

/// Returns an event as text, for example "7 BEGIN MOVED obstacle/a obstacle/b".
inline std::string told(const PairEvent& event, const Structure& structure) {
  return std::to_string(event.number) + " " + nameOf(event.kind) + " " + nameOf(event.cause) + " " +
         structure.bodies[event.first].name + " " + structure.bodies[event.second].name;
}

inline std::vector<std::string> eventsOf(const Snapshot& snapshot) {
  std::vector<std::string> events;
  for (const PairEvent& event : snapshot.events()) events.push_back(told(event, snapshot.structureOf(event)));
  return events;
}

}  // namespace test
}  // namespace hgrid
