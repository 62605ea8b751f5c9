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

/// Counts what came in and what was refused, and logs refusals, at most one line per second and cause.
/// Causes are few and chosen by the node, never by the sender, so the ledger stays small. Any thread.
class Ledger {
 public:
  /// Adds to a counter named as in "tf.accepted".
  void count(const std::string& what, std::uint64_t by = 1);
  /// Counts "<where>.<CODE>" and logs the sentence as a warning, with how many were not logged since.
  void refuse(const std::string& where, const Refusal& refusal);
  /// As refuse(), for the exception that is being handled: call this in a catch block only. Returns that exception as a
  /// Refusal, see caughtRefusal(). If there is no memory for that, the fault counts as "unreported" at least.
  Refusal fault(const char* where) noexcept;
  /// All counters by name, "unreported" among them unless it is 0.
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
  const Refusal no_memory_{Code::limit, "the memory that is left does not suffice to say what failed"};
};

/// The exception that is being handled, as a Refusal: itself if it is one, limit for std::bad_alloc, else internal.
/// Call this in a catch block only.
Refusal caughtRefusal();

}  // namespace hgrid
