// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

#include <chrono>
#include <functional>
#include <mutex>
#include <vector>

#include "node/diagnostics/ledger.h"

namespace hgrid {

class World;

/// A queue of changes of the world that other threads ask for. A tick makes them at its begin, in the order in which
/// they were added.
class TickJobs {
 public:
  using Job = std::function<void(World&)>;

  /// @param is_ending  called by threads that wait in run(): whether the node is about to end
  /// @param patience   how long run() waits for a tick. A tick takes milliseconds; if none comes for longer, it hangs.
  explicit TickJobs(
      std::function<bool()> is_ending = [] { return false; },
      std::chrono::milliseconds patience = std::chrono::seconds(10));

  /// Adds a job and returns at once. Any thread may call this.
  void add(Job job);
  /// Adds a job and waits until a tick has done it. Any thread but that of the ticks may call this.
  /// @throws what the job throws; Refusal busy if no tick does the job in time or if the node is about to end. A tick
  /// may still do the job after that.
  void run(const Job& job);

  /// Does all jobs. Only the thread of the ticks may call this.
  ///
  /// A job of add() that throws is counted in `ledger` as "job.failed.<CODE>" and done again at the next call, because
  /// its change of the world would be lost otherwise. The other jobs are done all the same.
  void doAll(World& world, Ledger& ledger);

 private:
  const std::function<bool()> is_ending_;
  const std::chrono::milliseconds patience_;
  std::mutex mutex_;
  std::vector<Job> added_;    // guarded by mutex_
  std::vector<Job> pending_;  // of the thread of the ticks
};

}  // namespace hgrid
