// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

#include <chrono>
#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "node/health/start_grace.h"
#include "node/tick/tick.h"

namespace hgrid {

/// Logs one line when the world becomes complete, when it stops being complete, and when the cause changes. The cause
/// changes if other sources become incomplete, a body becomes LOST or worse, or the list of pairs becomes truncated.
/// One thread may use it.
///
/// Does not log an incomplete world during the StartGrace.
///
/// It does not compare sentences, because they contain ages, which change in every tick.
class CompletenessLog {
 public:
  using Time = std::chrono::steady_clock::time_point;
  /// Least time between two warnings. A cause that is shorter is not logged; a cause that lasts is logged later.
  static constexpr std::chrono::seconds kPause{1};

  struct Line {
    bool complete;  ///< true: log the line as information; false: as a warning
    std::string text;
  };

  explicit CompletenessLog(Time started) : quiet_until_(StartGrace(started).end()) {}

  /// Logs the line that next() returns. Call this for every tick.
  void log(const Tick& tick);
  /// Compares the tick with the state that was logged last. @returns the line to log; nullopt if nothing changed, or
  /// if the last warning is younger than kPause
  std::optional<Line> next(const Tick& tick);

 private:
  /// The completeness of one tick, without ages and other values that differ in every tick.
  struct State {
    bool complete = false, has_world = false, truncated = false;
    Freshness worst = Freshness::stale;  // worst state of a body; states better than STALE do not matter
    std::size_t not_ready = 0;           // number of things that are missing, while there is no world
    std::string waits_for;               // name of the first of them
    std::vector<std::string> sources;    // names of the sources that are not complete, sorted
  };
  static State stateOf(const Tick& tick);
  bool isKnown(const State& state) const;

  Time quiet_until_;            // no warning before this time
  std::optional<State> known_;  // the state that was logged last; nullopt: none yet
};

}  // namespace hgrid
