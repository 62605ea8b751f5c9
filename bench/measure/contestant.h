// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

#include <sys/types.h>

#include <functional>
#include <string>
#include <vector>

#include "bench/measure/sample.h"

namespace hgrid {
namespace bench {

/// Runs a peer in a child process. If the peer crashes or never returns, the benchmark reports this and goes on.
class Contestant {
 public:
  /// Runs the peer for about `budget_ms` milliseconds and returns the samples.
  using Play = std::function<std::vector<Sample>(double budget_ms)>;

  /// Forks the child process. The child calls `make` when play() is called for the first time. If `threads` is 1, the
  /// child is pinned to the last processor that it may use.
  /// @throws std::runtime_error if the system provides no pipe or no process
  Contestant(const std::function<Play()>& make, int threads);
  ~Contestant();
  Contestant(const Contestant&) = delete;
  Contestant& operator=(const Contestant&) = delete;

  /// Runs the peer for one block of about `budget_ms` [ms] and stores the samples. If the child process does not answer
  /// within `limit_s` [s], ends it. Does nothing if the child process has already ended.
  void play(double budget_ms, double limit_s);

  const std::vector<std::vector<Sample>>& blocks() const { return blocks_; }
  /// Returns "ok", or the reason why the child process has ended, as text for the table.
  const std::string& status() const { return status_; }

 private:
  void end(const std::string& status);

  pid_t child_ = -1;
  int to_child_ = -1, from_child_ = -1;
  std::vector<std::vector<Sample>> blocks_;
  std::string status_ = "ok";
};

}  // namespace bench
}  // namespace hgrid
