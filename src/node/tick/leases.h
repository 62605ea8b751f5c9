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

  /// Returns the tick that a request asks for.
  /// @param newest  the newest tick; it has a snapshot
  /// @throws Refusal conflict for a lease of another epoch, extrapolation if the tick is not kept any more,
  /// out_of_range for a negative duration
  std::shared_ptr<const Tick> find(const ::hgrid_proximity::Lease& asked, const std::shared_ptr<const Tick>& newest);
  /// Keeps a tick that find() returned as long as the request wants, or longer if another request wants that.
  /// @returns how responses name the tick, and how long it is kept: 0 if there is no room for it
  ::hgrid_proximity::Lease keep(const ::hgrid_proximity::Lease& asked, const std::shared_ptr<const Tick>& tick);
  /// Forgets the ticks whose time is over, and those of other epochs. @param epoch  the present epoch
  void dropEnded(std::uint64_t epoch);

 private:
  using Clock = std::chrono::steady_clock;
  struct Kept {
    std::shared_ptr<const Tick> tick;
    Clock::time_point end;
  };
  std::vector<Kept> takeEnded(Clock::time_point now, std::uint64_t epoch);

  std::mutex mutex_;
  std::vector<Kept> kept_;
};

}  // namespace hgrid
