// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#include "node/time/tick_time.h"

#include <algorithm>
#include <cmath>

namespace hgrid {

TickTime::TickTime(double max_wait) : max_wait_(std::llround(1e9 * max_wait)) {}

Time TickTime::choose(const std::vector<Time>& newest, Time now) {
  if (newest.empty()) return last_ = std::max(last_, now);
  const auto newestNotAfter = [&](Time latest) {
    Time found{-1};
    for (const Time time : newest) {
      if (time <= latest) found = std::max(found, time);
    }
    return found;
  };
  const Time latest = now + max_wait_;
  Time pace = newestNotAfter(now);
  if (now - pace > max_wait_) pace = newestNotAfter(latest);
  if (pace.count() < 0) pace = latest;  // every frame is stamped too far ahead
  keeps_up_from_ = pace - max_wait_;
  Time common = pace;
  for (const Time time : newest) {
    if (time >= keeps_up_from_) common = std::min(common, time);
  }
  return last_ = std::max(last_, common);
}

}  // namespace hgrid
