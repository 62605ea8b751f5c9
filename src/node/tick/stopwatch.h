// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

#include <chrono>
#include <map>
#include <string>
#include <vector>

namespace hgrid {

/// How long the parts of the work took over the last ticks. One thread.
class Stopwatch {
 public:
  struct Summary {
    double last = 0.0, median = 0.0, p99 = 0.0, max = 0.0;  // [s]
  };
  static constexpr std::size_t kTicks = 500;

  void add(const std::string& part, std::chrono::nanoseconds duration);
  /// Medians and the like, each made anew once a second, since every message shows them.
  const std::map<std::string, Summary>& summaries() const { return summaries_; }
  /// Makes those of one part anew at most: sorting all in one tick would make that tick a slow one.
  void summarise(std::chrono::steady_clock::time_point now);
  std::size_t ticks() const;

 private:
  struct Ring {
    std::vector<double> values;
    std::size_t next = 0;
  };
  std::map<std::string, Ring> parts_;
  std::map<std::string, Summary> summaries_;
  std::string last_part_;       // that was summarised
  std::vector<double> sorted_;  // scratch
  std::chrono::steady_clock::time_point summarised_{};
};

}  // namespace hgrid
