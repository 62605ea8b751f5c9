// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

#include <hgrid_proximity/Lease.h>

#include <chrono>
#include <memory>
#include <mutex>
#include <vector>

#include "node/tick/tick.h"

namespace hgrid {

/// Keeps ticks for a while, so that several requests can be answered from the same one. Any number of threads may use
/// it.
class Leases {
 public:
  static constexpr std::size_t kMost = 16;  ///< number of ticks that are kept at the same time

  /// Returns the tick that a request asks for, and keeps it as long as the request wants.
  /// @param newest  the newest tick; it has a snapshot
  /// @param granted  receives how the response names the tick, and how long it is kept
  /// @throws Refusal conflict for a lease of another epoch, extrapolation if the tick is not kept any more,
  /// out_of_range for a negative duration, limit if too many ticks are kept
  std::shared_ptr<const Tick> take(const ::hgrid_proximity::Lease& asked, const std::shared_ptr<const Tick>& newest,
                                   ::hgrid_proximity::Lease& granted);
  /// Forgets the ticks whose time is over.
  void dropEnded();

 private:
  using Clock = std::chrono::steady_clock;
  struct Kept {
    std::shared_ptr<const Tick> tick;
    Clock::time_point end;
  };
  void drop(Clock::time_point now);

  std::mutex mutex_;
  std::vector<Kept> kept_;
};

}  // namespace hgrid
