// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

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
  /// All counters by name.
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
};

}  // namespace hgrid
