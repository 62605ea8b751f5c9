// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#include "node/tf/publisher_clocks.h"

#include <algorithm>
#include <cmath>

namespace hgrid {

void PublisherClocks::note(const std::string& publisher, Time offset, Time reading) {
  auto found = entries_.find(publisher);
  if (found == entries_.end()) {
    if (!makeRoom(reading)) return;
    found = entries_.emplace(publisher, Entry{}).first;
  }
  Entry& entry = found->second;
  if (entry.current.messages > 0 && reading - entry.current.begin >= kWindow) {
    entry.judged = entry.current;
    entry.current = Window{};
  }
  Window& window = entry.current;
  if (window.messages++ == 0) {
    window = {reading, 1, offset, offset};
  } else {
    window.least = std::min(window.least, offset);
    window.largest = std::max(window.largest, offset);
  }
}

/// Removes publishers that have stopped if there are too many. @returns whether there is room for another one
bool PublisherClocks::makeRoom(Time reading) {
  if (entries_.size() < kMaxPublishers) return true;
  for (auto next = entries_.begin(); next != entries_.end();) {
    const bool silent = reading - next->second.current.begin > 2 * kWindow;
    next = silent ? entries_.erase(next) : std::next(next);
  }
  return entries_.size() < kMaxPublishers;
}

std::vector<ClockOffset> PublisherClocks::offsets(Time reading) const {
  std::vector<ClockOffset> found;
  for (const auto& [publisher, entry] : entries_) {
    const Window& window = entry.judged;
    if (window.messages < kLeastMessages || reading - entry.current.begin > 2 * kWindow) continue;
    if (window.least >= kAhead) found.push_back({publisher, seconds(window.least)});
    if (window.largest <= -kBehind) found.push_back({publisher, seconds(window.largest)});
  }
  std::stable_sort(found.begin(), found.end(),
                   [](const ClockOffset& a, const ClockOffset& b) { return std::abs(a.offset) > std::abs(b.offset); });
  return found;
}

}  // namespace hgrid
