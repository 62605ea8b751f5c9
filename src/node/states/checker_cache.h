// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

#include <chrono>
#include <memory>
#include <mutex>
#include <string>
#include <vector>

#include "hgrid_proximity/queries/state_checker.h"
#include "node/tick/tick.h"

namespace hgrid {

/// Keeps the checkers that requests have used, because preparing one takes longer than checking a hundred states. A
/// checker keeps its snapshot alive, so dropUnused() drops those that no request has used for a second. Any number of
/// threads may use it.
class CheckerCache {
 public:
  using Clock = std::chrono::steady_clock;
  static constexpr std::size_t kMost = 4;  ///< number of checkers that are kept

  /// Returns the checker of a robot in the snapshot of a tick. Makes it if it is not kept.
  /// @throws Refusal what the constructor of StateChecker throws
  std::shared_ptr<const StateChecker> get(const Tick& tick, const LoadedRobot& robot,
                                          const StateCheckerOptions& options,
                                          const std::shared_ptr<const NarrowPhase>& narrow_phase);
  /// Drops the checkers that were not used for a second. Call this regularly.
  void dropUnused(Clock::time_point now = Clock::now());

 private:
  struct Entry {
    std::string robot;
    StateCheckerOptions options;
    std::shared_ptr<const StateChecker> checker;
    Clock::time_point used;
  };

  std::mutex mutex_;
  std::vector<Entry> entries_;  // the one that was used last comes first
};

}  // namespace hgrid
