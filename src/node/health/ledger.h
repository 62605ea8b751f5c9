// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

#include <atomic>
#include <chrono>
#include <cstdint>
#include <map>
#include <mutex>
#include <string>

#include "hgrid_proximity/refusal.h"

namespace hgrid {

/// Counts what the node received and refused, and logs refusals, at most one line per second for each cause.
/// The node chooses the names of causes, never the sender, so the ledger stays small. Any thread may use it.
class Ledger {
 public:
  /// Adds `by` to the counter named `what`, for example "tf.accepted".
  void count(const std::string& what, std::uint64_t by = 1);
  /// Adds 1 to the counter "<where>.<CODE>" and logs the sentence as a warning. The line also says how many refusals of
  /// this cause were not logged since the last line.
  void refuse(const std::string& where, const Refusal& refusal);
  /// As refuse(), for the exception that is being handled. Call this only in a catch block. Returns that exception as a
  /// Refusal (see caughtRefusal()). If there is not enough memory for that, only the counter "unreported" grows.
  Refusal fault(const char* where) noexcept;
  /// Returns all counters by name, including "unreported" unless it is 0.
  std::map<std::string, std::uint64_t> counters() const;
  void clear();

 private:
  struct Line {
    std::chrono::steady_clock::time_point last{};
    std::uint64_t silent = 0;
  };
  mutable std::mutex mutex_;
  std::map<std::string, std::uint64_t> counters_;
  std::map<std::string, Line> lines_;
  std::atomic<std::uint64_t> unreported_{0};
  const Refusal no_memory_{Code::limit, "not enough memory is left to report what failed"};
};

/// Returns the exception that is being handled as a Refusal: unchanged if it is one, with Code::limit for
/// std::bad_alloc, otherwise with Code::internal. Call this only in a catch block.
Refusal caughtRefusal();

}  // namespace hgrid
