// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

#include <chrono>

#include "node/tick/tick.h"

namespace hgrid {

/// Returns how long RViz shows a marker that is not published again. It is long enough that nothing flickers when a
/// message comes late, and so short that the picture vanishes soon after the node has ended or hangs.
///
/// RViz counts the time by ROS time. If the node ends while simulated time stands still, RViz keeps the picture until
/// the time goes on.
std::chrono::duration<double> markerLifetime(const Params& params);

/// What the markers show: a tick and, if they were measured in time, the distances of its pairs.
struct ShownTick {
  const Tick* tick = nullptr;  ///< null: no tick is new enough, so nothing may be shown
  const PairDistances* distances = nullptr;
};

/// Chooses the measured tick, or the newest one if nothing was measured. A tick that is too old is not shown: if ticks
/// or measurements hang, the thread that publishes markers must not show an old world for ever.
/// @param measured  null: nothing was measured
ShownTick shownTick(const Tick& newest, const MeasuredTick* measured, std::chrono::steady_clock::time_point now);

}  // namespace hgrid
