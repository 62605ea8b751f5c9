// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#include "ledger.h"

#include <ros/console.h>

namespace hgrid {

void Ledger::count(const std::string& what, std::uint64_t by) {
  const std::lock_guard<std::mutex> lock(mutex_);
  counters_[what] += by;
}

void Ledger::refuse(const std::string& where, const Refusal& refusal) {
  const std::string cause = where + "." + name(refusal.code());
  const auto now = std::chrono::steady_clock::now();
  std::uint64_t silent = 0;
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    ++counters_[cause];
    Line& line = lines_[cause];
    if (line.last.time_since_epoch().count() != 0 && now - line.last < std::chrono::seconds(1)) {
      ++line.silent;
      return;
    }
    line.last = now;
    std::swap(silent, line.silent);
  }
  if (silent > 0) {
    ROS_WARN("%s: %s (and %llu more like it)", cause.c_str(), refusal.what(), static_cast<unsigned long long>(silent));
  } else {
    ROS_WARN("%s: %s", cause.c_str(), refusal.what());
  }
}

std::map<std::string, std::uint64_t> Ledger::counters() const {
  const std::lock_guard<std::mutex> lock(mutex_);
  return counters_;
}

void Ledger::clear() {
  const std::lock_guard<std::mutex> lock(mutex_);
  counters_.clear();
}

}  // namespace hgrid
