// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

#include <chrono>
#include <map>
#include <string>
#include <vector>

namespace hgrid {

/// Measures how long the parts of a tick take, over the last kTicks ticks. One thread.
class Stopwatch {
 public:
  struct Summary {
    double last = 0.0, median = 0.0, p99 = 0.0, max = 0.0;  // [s]
  };
  static constexpr std::size_t kTicks = 500;

  /// Stores the duration of a part in the newest tick.
  void add(const std::string& part, std::chrono::nanoseconds duration);
  /// The summary of every part by name. summarize() updates each of them about once a second.
  const std::map<std::string, Summary>& summaries() const { return summaries_; }
  /// Updates the summary of one part at most, because sorting the durations of all parts would make a tick slow.
  /// Call this once per tick.
  void summarize(std::chrono::steady_clock::time_point now);
  /// Number of ticks that the summaries cover.
  std::size_t ticks() const;

 private:
  struct Ring {
    std::vector<double> values;
    std::size_t next = 0;
  };
  std::map<std::string, Ring> parts_;
  std::map<std::string, Summary> summaries_;
  std::string last_part_;       // that was summarized
  std::vector<double> sorted_;  // scratch
  std::chrono::steady_clock::time_point summarized_{};
};

}  // namespace hgrid
