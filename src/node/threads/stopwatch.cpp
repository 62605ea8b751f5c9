// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#include "node/threads/stopwatch.h"

#include <algorithm>

namespace hgrid {

void Stopwatch::add(const std::string& part, std::chrono::nanoseconds duration) {
  Ring& ring = parts_[part];
  const double value = std::chrono::duration<double>(duration).count();
  if (ring.values.empty()) summaries_[part] = {value, value, value, value};
  if (ring.values.size() < kTicks) {
    ring.values.push_back(value);
  } else {
    ring.values[ring.next] = value;
  }
  ring.next = (ring.next + 1) % kTicks;
  summaries_[part].last = value;
}

void Stopwatch::summarize(std::chrono::steady_clock::time_point now) {
  const std::chrono::duration<double> pause(parts_.empty() ? 1.0 : 1.0 / static_cast<double>(parts_.size()));
  if (parts_.empty() || now - summarized_ < pause) return;
  summarized_ = now;
  auto part = parts_.upper_bound(last_part_);
  if (part == parts_.end()) part = parts_.begin();
  last_part_ = part->first;
  sorted_ = part->second.values;
  std::sort(sorted_.begin(), sorted_.end());
  Summary& summary = summaries_[part->first];
  summary.median = sorted_[sorted_.size() / 2];
  summary.p99 = sorted_[sorted_.size() * 99 / 100];
  summary.max = sorted_.back();
}

std::size_t Stopwatch::ticks() const { return parts_.empty() ? 0 : parts_.begin()->second.values.size(); }

}  // namespace hgrid
