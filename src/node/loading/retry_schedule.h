// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

#include <chrono>

namespace hgrid {

/// Says when loads that failed are tried again: the first time at once, then after pauses that grow from kFirstPause to
/// kLongestPause, each twice as long as the one before. The pause never shrinks.
class RetrySchedule {
 public:
  using Time = std::chrono::steady_clock::time_point;
  static constexpr std::chrono::milliseconds kFirstPause{500};
  static constexpr std::chrono::milliseconds kLongestPause{10000};

  /// Whether it is time to try.
  bool isDue(Time now) const { return now >= next_; }
  /// Call this when a try begins.
  void noteTry(Time now);

 private:
  std::chrono::milliseconds pause_{0};
  Time next_{};
};

}  // namespace hgrid
