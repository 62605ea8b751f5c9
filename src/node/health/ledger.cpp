// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#include "node/health/ledger.h"

#include <ros/console.h>

#include <new>

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
    ROS_WARN("%s: %s (and %llu more with the same cause, not logged)", cause.c_str(), refusal.what(),
             static_cast<unsigned long long>(silent));
  } else {
    ROS_WARN("%s: %s", cause.c_str(), refusal.what());
  }
}

Refusal Ledger::fault(const char* where) noexcept {
  try {
    const Refusal what = caughtRefusal();
    refuse(where, what);
    return what;
  } catch (...) {
    ++unreported_;
    return no_memory_;
  }
}

std::map<std::string, std::uint64_t> Ledger::counters() const {
  const std::lock_guard<std::mutex> lock(mutex_);
  std::map<std::string, std::uint64_t> counters = counters_;
  if (unreported_ > 0) counters["unreported"] = unreported_;
  return counters;
}

void Ledger::clear() {
  const std::lock_guard<std::mutex> lock(mutex_);
  counters_.clear();
  unreported_ = 0;
}

Refusal caughtRefusal() {
  try {
    throw;
  } catch (const Refusal& refusal) {
    return refusal;
  } catch (const std::bad_alloc&) {
    return {Code::limit, "not enough memory is left"};
  } catch (const std::exception& error) {
    return {Code::internal, error.what()};
  } catch (...) {
    return {Code::internal, "an exception of an unknown type was thrown"};
  }
}

}  // namespace hgrid
