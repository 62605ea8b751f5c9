// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

#include <chrono>
#include <map>
#include <string>
#include <vector>

namespace hgrid {

/// Stores how long the parts of the last kTicks ticks took. Only one thread may use it.
class Stopwatch {
 public:
  /// Durations of one part, over the last kTicks ticks.
  struct Summary {
    double last = 0.0, median = 0.0, p99 = 0.0, max = 0.0;  // [s]
  };
  static constexpr std::size_t kTicks = 500;

  /// Stores how long a part of the newest tick took.
  void add(const std::string& part, std::chrono::nanoseconds duration);
  /// Returns the summaries of all parts, by name of the part. summarize() updates each of them about once per second.
  const std::map<std::string, Summary>& summaries() const { return summaries_; }
  /// Updates the summary of at most one part, because sorting the durations of all parts would make a tick slow.
  /// Call this once per tick.
  void summarize(std::chrono::steady_clock::time_point now);
  /// Returns the number of ticks that the summaries cover.
  std::size_t ticks() const;

 private:
  struct Ring {
    std::vector<double> values;  // [s] durations of one part in the last ticks
    std::size_t next = 0;        // index in `values` of the next duration
  };
  std::map<std::string, Ring> parts_;
  std::map<std::string, Summary> summaries_;
  std::string last_part_;                               // name of the part that was summarized last
  std::vector<double> sorted_;                          // buffer of summarize()
  std::chrono::steady_clock::time_point summarized_{};  // when last_part_ was summarized
};

}  // namespace hgrid
