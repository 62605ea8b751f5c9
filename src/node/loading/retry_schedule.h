// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

#include <chrono>

namespace hgrid {

/// Decides when failed loads are tried again. The first try is due at once. Then the pauses double from kFirstPause to
/// kLongestPause. A pause is never shorter than the previous one.
class RetrySchedule {
 public:
  using Time = std::chrono::steady_clock::time_point;
  static constexpr std::chrono::milliseconds kFirstPause{500};
  static constexpr std::chrono::milliseconds kLongestPause{10000};

  /// Whether a try is due.
  bool isDue(Time now) const { return now >= next_; }
  /// Call this when a try begins.
  void noteTry(Time now);

 private:
  std::chrono::milliseconds pause_{0};
  Time next_{};
};

}  // namespace hgrid
