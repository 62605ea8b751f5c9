// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#include "node/tick/tick_jobs.h"

#include <algorithm>
#include <iterator>
#include <utility>

#include "node/services/guarded.h"

namespace hgrid {

void TickJobs::add(Job job) {
  const std::lock_guard<std::mutex> lock(mutex_);
  added_.push_back(std::move(job));
}

void TickJobs::doAll(World& world, Ledger& ledger) {
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    pending_.insert(pending_.end(), std::make_move_iterator(added_.begin()), std::make_move_iterator(added_.end()));
    added_.clear();
  }
  const auto succeeds = [&](const Job& job) { return !guarded(ledger, "job.failed", [&] { job(world); }); };
  pending_.erase(std::remove_if(pending_.begin(), pending_.end(), succeeds), pending_.end());
}

}  // namespace hgrid
