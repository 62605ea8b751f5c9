// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

#include <cstddef>
#include <memory>
#include <type_traits>

namespace hgrid {

/// Threads that wait for work. One caller at a time; the caller works too.
class Workers {
 public:
  /// @param threads  how many work at once, the caller among them, at least 1; fewer if the system gives no more
  explicit Workers(int threads);
  ~Workers();

  int threads() const;

  /// Calls job(0, thread) .. job(count - 1, thread), each once and in any order; returns when all are done. The thread
  /// is a number below threads(); each of them begins with a share of its own, the same every time, of jobs that follow
  /// each other. If jobs throw, one of their exceptions is thrown again when all are done; with one thread or one job,
  /// the first exception ends the run at once. Allocates nothing unless a job throws.
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
