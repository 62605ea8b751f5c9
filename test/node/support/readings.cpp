// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#include "readings.h"

#include <hgrid_proximity/BodyState.h>

namespace hgrid {
namespace test {

const msg::BodyStatus* entryOf(const msg::Status& status, const std::string& body) {
  for (const msg::BodyStatus& entry : status.bodies) {
    if (entry.name == body) return &entry;
  }
  return nullptr;
}

int stateOf(const msg::Status& status, const std::string& body) {
  const msg::BodyStatus* entry = entryOf(status, body);
  return entry == nullptr ? int(msg::BodyState::FRESH) : entry->state;
}

std::uint64_t counter(const msg::Status& status, const std::string& name) {
  for (const msg::Counter& counter : status.counters) {
    if (counter.name == name) return counter.value;
  }
  return 0;
}

int indexOf(const msg::Pairs& pairs, const std::string& first, const std::string& second) {
  for (std::size_t i = 0; i < pairs.first.size(); ++i) {
    if (pairs.names[pairs.first[i]] == first && pairs.names[pairs.second[i]] == second) return static_cast<int>(i);
  }
  return -1;
}

std::vector<std::string> namesOf(const msg::Pairs& pairs) {
  std::vector<std::string> names;
  for (std::size_t i = 0; i < pairs.first.size(); ++i) {
    names.push_back(pairs.names[pairs.first[i]] + "|" + pairs.names[pairs.second[i]]);
  }
  return names;
}

std::vector<std::string> eventsOf(const msg::Events& events) {
  static constexpr const char* kKinds[] = {"BEGIN", "END"};
  static constexpr const char* kCauses[] = {"MOVED", "BODIES", "FILTER", "STALENESS", "EPOCH"};
  std::vector<std::string> told;
  for (std::size_t i = 0; i < events.number.size(); ++i) {
    told.push_back(std::to_string(events.number[i]) + " " + kKinds[events.kind[i]] + " " + kCauses[events.cause[i]] +
                   " " + events.names.at(events.first[i]) + "|" + events.names.at(events.second[i]));
  }
  return told;
}

}  // namespace test
}  // namespace hgrid
