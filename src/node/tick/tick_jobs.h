// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

#include <functional>
#include <mutex>
#include <vector>

#include "node/diagnostics/ledger.h"

namespace hgrid {

class World;

/// Changes of the world that other threads ask for. A tick makes them at its begin, in the order in which they came.
class TickJobs {
 public:
  using Job = std::function<void(World&)>;

  /// Any thread.
  void add(Job job);

  /// Does all jobs. Only the thread of the ticks calls this.
  ///
  /// A job that throws is counted in `ledger` as "job.failed.<CODE>" and done again at the next call, since what it
  /// says of the world would be lost otherwise. The other jobs are done all the same.
  void doAll(World& world, Ledger& ledger);

 private:
  std::mutex mutex_;
  std::vector<Job> added_;    // guarded by mutex_
  std::vector<Job> pending_;  // of the thread of the ticks
};

}  // namespace hgrid
