// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#include "node/publishers/shown_tick.h"

#include <algorithm>

namespace hgrid {
namespace {

using Seconds = std::chrono::duration<double>;

constexpr Seconds kLeastLifetime{1.0};
constexpr double kPeriods = 3.0;  // so many periods may pass without a tick or a message

}  // namespace

Seconds markerLifetime(const Params& params) {
  return std::max(kLeastLifetime, Seconds(kPeriods / params.marker_rate));
}

ShownTick shownTick(const Tick& newest, const MeasuredTick* measured, std::chrono::steady_clock::time_point now) {
  const Params& params = newest.settings->params;
  const double slowest = params.follow_data ? std::min(params.rate, params.heartbeat) : params.rate;
  const Seconds longest = std::max(markerLifetime(params), Seconds(kPeriods / slowest));
  const auto isNew = [&](const Tick& tick) { return now - tick.made.steady <= longest; };
  if (measured != nullptr && measured->distances && isNew(*measured->tick)) {
    return {measured->tick.get(), measured->distances.get()};
  }
  if (isNew(newest)) return {&newest, nullptr};
  return {};
}

}  // namespace hgrid
