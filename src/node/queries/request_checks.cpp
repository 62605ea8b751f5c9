// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#include "node/queries/request_checks.h"

#include "hgrid_proximity/refusal.h"

namespace hgrid {
namespace {

constexpr std::size_t kMostPatterns = 256, kLongestPattern = 512;  // patterns in a request; bytes in a pattern

}  // namespace

void checkPatterns(const std::vector<std::string>& patterns) {
  if (patterns.size() > kMostPatterns) {
    throw Refusal(Code::limit, "the query has " + std::to_string(patterns.size()) + " name patterns; at most " +
                                   std::to_string(kMostPatterns) + " are allowed");
  }
  for (const std::string& pattern : patterns) {
    if (pattern.size() <= kLongestPattern) continue;
    throw Refusal(Code::bad_id, "name pattern '" + printable(pattern, 48) + "' has " + std::to_string(pattern.size()) +
                                    " bytes; at most " + std::to_string(kLongestPattern) + " are allowed");
  }
}

std::optional<std::chrono::steady_clock::time_point> deadlineOf(double max_time) {
  constexpr double kLongest = 1e6;  // [s] a longer time counts as no limit
  if (!(max_time >= 0.0)) {
    throw Refusal(Code::out_of_range,
                  "max_time is " + text(max_time) + " s; it must be positive, or 0 for the default");
  }
  if (max_time == 0.0 || max_time > kLongest) return std::nullopt;
  using Clock = std::chrono::steady_clock;
  return Clock::now() + std::chrono::duration_cast<Clock::duration>(std::chrono::duration<double>(max_time));
}

std::chrono::steady_clock::time_point batchDeadlineOf(double max_time) {
  constexpr double kLongest = 10.0;  // [s]
  return *deadlineOf(max_time == 0.0 || max_time > kLongest ? kLongest : max_time);
}

void checkBatch(const char* what, std::size_t count, const Params& params) {
  if (count <= static_cast<std::size_t>(params.max_batch)) return;
  throw Refusal(Code::limit, "the request has " + std::to_string(count) + " " + what + "; at most " +
                                 std::to_string(params.max_batch) +
                                 " are allowed (~limits/max_batch). Split the request, or raise ~limits/max_batch");
}

}  // namespace hgrid
