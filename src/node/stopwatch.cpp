// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#include "stopwatch.h"

#include <algorithm>

namespace hgrid {

void Stopwatch::add(const std::string& part, std::chrono::nanoseconds duration) {
  Ring& ring = parts_[part];
  const double value = std::chrono::duration<double>(duration).count();
  if (ring.values.size() < kTicks) {
    ring.values.push_back(value);
  } else {
    ring.values[ring.next] = value;
  }
  ring.next = (ring.next + 1) % kTicks;
  summaries_[part].last = value;
}

void Stopwatch::summarise(std::chrono::steady_clock::time_point now) {
  if (now - summarised_ < std::chrono::seconds(1)) return;
  summarised_ = now;
  for (const auto& part : parts_) {
    std::vector<double> sorted = part.second.values;
    std::sort(sorted.begin(), sorted.end());
    Summary& summary = summaries_[part.first];
    summary.median = sorted[sorted.size() / 2];
    summary.p99 = sorted[sorted.size() * 99 / 100];
    summary.max = sorted.back();
  }
}

std::size_t Stopwatch::ticks() const { return parts_.empty() ? 0 : parts_.begin()->second.values.size(); }

}  // namespace hgrid
