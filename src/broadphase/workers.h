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

  /// Calls job(0, thread) .. job(count - 1, thread), each once and in any order. Returns when all jobs are done.
  /// `thread` is below threads(). Each thread begins with the same share of consecutive jobs every time.
  /// Allocates nothing.
  ///
  /// When a job throws, no thread begins another job. After all threads have finished theirs, the first exception is
  /// thrown to the caller. The workers can be used again.
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
