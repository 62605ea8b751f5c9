// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

#include <cstddef>
#include <memory>
#include <type_traits>

namespace hgrid {

/// A pool of threads that run jobs in parallel. One thread at a time may call run(). That thread runs jobs, too.
class Workers {
 public:
  /// @param threads  number of threads that work at once, including the caller, at least 1. If the system cannot
  ///                 create so many threads, there are fewer.
  explicit Workers(int threads);
  ~Workers();

  /// Returns the number of threads that work at once, including the caller.
  int threads() const;

  /// Calls job(0, thread) .. job(count - 1, thread), each once and in any order. Returns when all jobs are done.
  /// `thread` is the index of the thread that runs the job, 0 .. threads() - 1. For the same `count`, each thread
  /// starts with the same share of consecutive jobs in every call. Allocates nothing.
  ///
  /// When a job throws, no thread starts another job. After all threads have finished their current jobs, run() throws
  /// the first exception. Then run() can be called again.
  template <class Job>
  void run(std::size_t count, Job&& job) {
    runAll(
        count,
        [](void* what, std::size_t i, std::size_t thread) {
          (*static_cast<std::remove_reference_t<Job>*>(what))(i, thread);
        },
        &job);
  }

 private:
  void runAll(std::size_t count, void (*call)(void*, std::size_t, std::size_t), void* job);

  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace hgrid
