// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <mutex>
#include <string>
#include <vector>

#include "node/health/ledger.h"

namespace hgrid {

class World;

/// A queue of changes to the world that other threads request. Each tick begins with the waiting changes, in the order
/// in which they were added.
class TickJobs {
 public:
  using Job = std::function<void(World&)>;

  /// @param is_ending  returns whether the node is shutting down; threads that wait in run() call it
  /// @param patience   how long run() waits for a tick to start the job; ticks take milliseconds, so a timeout means
  /// that the tick thread hangs
  /// @param wake       called after a job was added, by the thread that added it, so that a tick begins soon
  explicit TickJobs(
      std::function<bool()> is_ending = [] { return false; },
      std::chrono::milliseconds patience = std::chrono::seconds(10), std::function<void()> wake = [] {});

  /// Adds a job and returns at once. Any thread may call this. If a job with the same key still waits, removes it. So
  /// add() never causes more waiting jobs than there are keys, even if no tick comes for a long time.
  void add(const std::string& key, Job job);
  /// Adds a job and waits until a tick has done it. Any thread except the tick thread may call this.
  /// @throws whatever the job throws; Refusal busy if no tick starts the job in time, or if the node is shutting down.
  /// If run() throws Refusal busy, it has removed the job from the queue, and no tick will do the job.
  void run(const Job& job);

  /// Does all waiting jobs. Only the tick thread may call this.
  ///
  /// If a job of add() throws, `ledger` counts it as "job.failed.<CODE>", and the next call does it again, because its
  /// change of the world must not be lost. The other jobs are still done.
  void doAll(World& world, Ledger& ledger);

  /// Returns the number of jobs that were added since the last call of doAll(). Any thread may call this.
  std::size_t waiting() const;

 private:
  /// A job and its key. The key of a job of run() is empty.
  struct Waiting {
    std::string key;
    std::uint64_t number;
    Job job;
  };
  std::uint64_t put(const std::string& key, Job job);
  void remove(std::uint64_t number);

  const std::function<bool()> is_ending_;
  const std::chrono::milliseconds patience_;
  const std::function<void()> wake_;
  mutable std::mutex mutex_;
  std::vector<Waiting> added_;     // guarded by mutex_
  std::uint64_t last_number_ = 0;  // guarded by mutex_
  std::vector<Waiting> pending_;   // jobs that doAll() must still do; only the tick thread uses it
};

}  // namespace hgrid
