// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

#include <chrono>
#include <optional>

namespace hgrid {

/// The time that a query may take. Reads the clock rarely, and never if there is no deadline. Only one thread may use
/// an object of this class.
class TimeBudget {
 public:
  using Clock = std::chrono::steady_clock;
  /// How long the work between two calls of isOver() takes.
  enum class Step { fast, slow };

  explicit TimeBudget(const std::optional<Clock::time_point>& deadline) : deadline_(deadline) {}

  /// Returns whether the deadline has passed. Reads the clock before each slow step, before the first fast step, and
  /// then before every kFastSteps-th fast step.
  bool isOver(Step next) {
    if (!deadline_ || over_) return over_;
    if (next == Step::fast && steps_++ % kFastSteps != 0) return false;
    return over_ = Clock::now() >= *deadline_;
  }
  /// Returns whether a call of isOver() has returned true.
  bool wasOver() const { return over_; }

 private:
  static constexpr unsigned kFastSteps = 32;  // so many fast steps take about 3 us, much longer than reading the clock

  std::optional<Clock::time_point> deadline_;
  unsigned steps_ = 0;
  bool over_ = false;
};

}  // namespace hgrid
