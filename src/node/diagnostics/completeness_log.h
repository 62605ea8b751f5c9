// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

#include <chrono>
#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "node/tick/tick.h"

namespace hgrid {

/// Logs one line when the world becomes complete, when it stops being complete, and when the cause is another one:
/// other sources are incomplete, a body has become LOST or worse, the list of pairs is truncated. One thread.
///
/// It does not compare sentences, because the ages in them change with every tick.
class CompletenessLog {
 public:
  using Time = std::chrono::steady_clock::time_point;
  /// For so long after the start, an incomplete world is not reported, because its sources may be starting too.
  static constexpr std::chrono::seconds kGrace{1};

  struct Line {
    bool complete;  ///< it is information; otherwise it is a warning
    std::string text;
  };

  explicit CompletenessLog(Time started) : started_(started) {}

  /// Call this for every tick. Logs the line that next() returns, warnings at most once a second.
  void log(const Tick& tick);
  /// Compares the tick with that of the last call. @returns the line to be logged; nullopt if nothing changed
  std::optional<Line> next(const Tick& tick);

 private:
  /// What one tick says about completeness, without ages and other values that differ in every tick.
  struct State {
    bool complete = false, has_world = false, truncated = false;
    Freshness worst = Freshness::stale;  // state of a body; better ones do not matter
    std::size_t not_ready = 0;           // how many things are lacking, while there is no world
    std::string waits_for;               // what the first of them is about
    std::vector<std::string> sources;    // that are incomplete, sorted
  };
  static State stateOf(const Tick& tick);
  bool isKnown(const State& state) const;

  const Time started_;
  std::optional<State> known_;  // that was logged last; nullopt: none was
};

}  // namespace hgrid
