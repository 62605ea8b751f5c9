// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#include "node/tick/leases.h"

#include <algorithm>
#include <cmath>

namespace hgrid {
namespace {

bool isSame(const Tick& tick, const ::hgrid_proximity::Lease& lease) {
  return tick.epoch == lease.epoch && tick.snapshot->sequence() == lease.sequence;
}

}  // namespace

std::shared_ptr<const Tick> Leases::take(const ::hgrid_proximity::Lease& asked,
                                         const std::shared_ptr<const Tick>& newest, ::hgrid_proximity::Lease& granted) {
  const double longest = newest->settings->params.lease_max, wanted = asked.lasts.toSec();
  if (wanted < 0.0) {
    throw Refusal(Code::out_of_range, "lasts of the lease is " + text(wanted) + " s; it must be 0 or positive");
  }
  const std::lock_guard<std::mutex> lock(mutex_);
  const Clock::time_point now = Clock::now();
  drop(now);
  std::shared_ptr<const Tick> tick = newest;
  auto found = kept_.end();
  if (asked.sequence != 0 && asked.epoch != newest->epoch) {
    throw Refusal(Code::conflict, "the lease is of epoch " + std::to_string(asked.epoch) +
                                      ", but the world is in epoch " + std::to_string(newest->epoch) +
                                      "; ask for a new lease");
  }
  const ::hgrid_proximity::Lease* named = &asked;
  ::hgrid_proximity::Lease of_newest;
  if (asked.sequence == 0) {
    of_newest.epoch = newest->epoch;
    of_newest.sequence = newest->snapshot->sequence();
    named = &of_newest;
  }
  found = std::find_if(kept_.begin(), kept_.end(), [&](const Kept& one) { return isSame(*one.tick, *named); });
  if (found != kept_.end()) {
    tick = found->tick;
  } else if (!isSame(*newest, *named)) {
    throw Refusal(Code::extrapolation, "the node does not keep tick " + std::to_string(asked.sequence) +
                                           " any more; the newest is " + std::to_string(newest->snapshot->sequence()) +
                                           ". A lease lasts as long as its request says, at most " + text(longest) +
                                           " s (~lease_max)");
  }
  const auto end =
      now + std::chrono::duration_cast<Clock::duration>(std::chrono::duration<double>(std::min(wanted, longest)));
  if (found != kept_.end()) {
    found->end = std::max(found->end, end);
  } else if (wanted > 0.0) {
    if (kept_.size() >= kMost) {
      throw Refusal(Code::limit, "the node keeps " + std::to_string(kMost) +
                                     " ticks for other leases already; wait until one of them ends");
    }
    kept_.push_back({tick, end});
    found = kept_.end() - 1;
  }
  granted.epoch = tick->epoch;
  granted.sequence = tick->snapshot->sequence();
  granted.lasts = ros::Duration(found == kept_.end() ? 0.0 : std::chrono::duration<double>(found->end - now).count());
  return tick;
}

void Leases::dropEnded() {
  const std::lock_guard<std::mutex> lock(mutex_);
  drop(Clock::now());
}

/// Forgets the ticks whose time is over. The mutex is locked.
void Leases::drop(Clock::time_point now) {
  kept_.erase(std::remove_if(kept_.begin(), kept_.end(), [&](const Kept& one) { return one.end <= now; }), kept_.end());
}

}  // namespace hgrid
