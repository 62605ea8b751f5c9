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

/// A peer at work in a process of its own, so that one that crashes or never ends is a line in a table.
class Contestant {
 public:
  /// Plays for about so many milliseconds and reports what it has timed.
  using Play = std::function<std::vector<Sample>(double budget_ms)>;

  /// Forks; `make` runs in the new process, at first use. One thread: pinned to the last processor that there is.
  Contestant(const std::function<Play()>& make, int threads);
  ~Contestant();
  Contestant(const Contestant&) = delete;
  Contestant& operator=(const Contestant&) = delete;

  /// One block of play; its samples are kept. Does nothing once the contestant is out.
  void play(double budget_ms, double limit_s);

  const std::vector<std::vector<Sample>>& blocks() const { return blocks_; }
  /// "ok", or why the contestant is out: a sentence for the table.
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
