// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#include "node/states/checker_cache.h"

#include <algorithm>
#include <utility>

namespace hgrid {
namespace {

constexpr std::chrono::seconds kUnused{1};  // without use for this long, a checker is dropped

bool equal(const StateCheckerOptions& a, const StateCheckerOptions& b) {
  return a.ignore == b.ignore && a.group == b.group && a.robots == b.robots && a.world_frame == b.world_frame;
}

}  // namespace

std::shared_ptr<const StateChecker> CheckerCache::get(const Tick& tick, const LoadedRobot& robot,
                                                      const StateCheckerOptions& options,
                                                      const std::shared_ptr<const NarrowPhase>& narrow_phase) {
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    const auto found = std::find_if(entries_.begin(), entries_.end(), [&](const Entry& entry) {
      return &entry.checker->snapshot() == tick.snapshot.get() && entry.robot == robot.name &&
             equal(entry.options, options);
    });
    if (found != entries_.end()) {
      found->used = Clock::now();
      std::rotate(entries_.begin(), found, found + 1);
      return entries_.front().checker;
    }
  }
  Entry made{robot.name, options, nullptr, Clock::now()};
  made.checker = std::make_shared<const StateChecker>(tick.snapshot, *robot.read->joints->kinematics, robot.name,
                                                      narrow_phase, options);
  const std::shared_ptr<const StateChecker> checker = made.checker;
  Entry dropped;  // destroyed after the mutex is unlocked, because that takes time
  const std::lock_guard<std::mutex> lock(mutex_);
  if (entries_.size() == kMost) {
    dropped = std::move(entries_.back());
    entries_.pop_back();
  }
  entries_.insert(entries_.begin(), std::move(made));
  return checker;
}

void CheckerCache::dropUnused(Clock::time_point now) {
  std::vector<Entry> dropped;  // destroyed after the mutex is unlocked
  const std::lock_guard<std::mutex> lock(mutex_);
  while (!entries_.empty() && now - entries_.back().used > kUnused) {
    dropped.push_back(std::move(entries_.back()));
    entries_.pop_back();
  }
}

}  // namespace hgrid
