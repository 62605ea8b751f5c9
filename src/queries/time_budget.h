// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

#include <chrono>
#include <optional>

namespace hgrid {

/// The time that a query may take. Reads the clock rarely, and not at all without a deadline. One thread.
class TimeBudget {
 public:
  using Clock = std::chrono::steady_clock;
  /// What a query does between two calls of isOver().
  enum class Step { fast, slow };

  explicit TimeBudget(const std::optional<Clock::time_point>& deadline) : deadline_(deadline) {}

  /// Whether the deadline has passed. Reads the clock before each slow step and before one of kFastSteps fast ones, the
  /// first included.
  bool isOver(Step next) {
    if (!deadline_ || over_) return over_;
    if (next == Step::fast && steps_++ % kFastSteps != 0) return false;
    return over_ = Clock::now() >= *deadline_;
  }
  /// Whether a call of isOver() has said so.
  bool wasOver() const { return over_; }

 private:
  static constexpr unsigned kFastSteps = 32;  // of about 0.1 us each: far more than the clock takes

  std::optional<Clock::time_point> deadline_;
  unsigned steps_ = 0;
  bool over_ = false;
};

}  // namespace hgrid
