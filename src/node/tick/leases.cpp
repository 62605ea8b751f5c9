// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#include "node/tick/leases.h"

#include <algorithm>
#include <iterator>

namespace hgrid {
namespace {

bool isSame(const Tick& tick, const ::hgrid_proximity::Lease& lease) {
  return tick.epoch == lease.epoch && tick.snapshot->sequence() == lease.sequence;
}

}  // namespace

std::shared_ptr<const Tick> Leases::find(const ::hgrid_proximity::Lease& asked,
                                         const std::shared_ptr<const Tick>& newest) {
  if (asked.lasts < ros::Duration(0)) {
    throw Refusal(Code::out_of_range,
                  "lasts of the lease is " + text(asked.lasts.toSec()) + " s; it must be 0 or positive");
  }
  if (asked.sequence == 0 || isSame(*newest, asked)) return newest;
  if (asked.epoch != newest->epoch) {
    throw Refusal(Code::conflict, "the lease is of epoch " + std::to_string(asked.epoch) +
                                      ", but the world is in epoch " + std::to_string(newest->epoch) +
                                      "; ask for a new lease");
  }
  const std::lock_guard<std::mutex> lock(mutex_);
  const Clock::time_point now = Clock::now();
  for (const Kept& one : kept_) {
    if (one.end > now && isSame(*one.tick, asked)) return one.tick;
  }
  throw Refusal(Code::extrapolation, "the node does not keep tick " + std::to_string(asked.sequence) +
                                         " any more; the newest is " + std::to_string(newest->snapshot->sequence()) +
                                         ". A lease lasts as long as its last request says, at most " +
                                         text(newest->settings->params.lease_max) + " s (~limits/lease_max)");
}

::hgrid_proximity::Lease Leases::keep(const ::hgrid_proximity::Lease& asked, const std::shared_ptr<const Tick>& tick) {
  using Seconds = std::chrono::duration<double>;
  ::hgrid_proximity::Lease granted;
  granted.epoch = tick->epoch;
  granted.sequence = tick->snapshot->sequence();
  const double wanted = std::min(asked.lasts.toSec(), tick->settings->params.lease_max);
  std::vector<Kept> ended;  // destroyed after the mutex is unlocked
  const std::lock_guard<std::mutex> lock(mutex_);
  const Clock::time_point now = Clock::now();
  ended = takeEnded(now, tick->epoch);
  const auto end = now + std::chrono::duration_cast<Clock::duration>(Seconds(wanted));
  auto found = std::find_if(kept_.begin(), kept_.end(), [&](const Kept& one) { return one.tick == tick; });
  if (found == kept_.end()) {
    if (!(wanted > 0.0) || kept_.size() >= kMost) return granted;
    kept_.push_back({tick, end});
    found = kept_.end() - 1;
  }
  found->end = std::max(found->end, end);
  granted.lasts = ros::Duration(Seconds(found->end - now).count());
  return granted;
}

void Leases::dropEnded(std::uint64_t epoch) {
  std::vector<Kept> ended;  // destroyed after the mutex is unlocked
  const std::lock_guard<std::mutex> lock(mutex_);
  ended = takeEnded(Clock::now(), epoch);
}

/// Removes and returns the ticks whose time is over, and those of other epochs. The mutex is locked.
std::vector<Leases::Kept> Leases::takeEnded(Clock::time_point now, std::uint64_t epoch) {
  const auto first = std::partition(kept_.begin(), kept_.end(),
                                    [&](const Kept& one) { return one.end > now && one.tick->epoch == epoch; });
  std::vector<Kept> ended(std::make_move_iterator(first), std::make_move_iterator(kept_.end()));
  kept_.erase(first, kept_.end());
  return ended;
}

}  // namespace hgrid
