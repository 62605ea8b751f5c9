// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

#include <chrono>
#include <string>

#include "hgrid_proximity/refusal.h"
#include "node/health/ledger.h"

namespace hgrid {

/// The first seconds of the node, in which robots, transforms and messages may still be on their way. Then it is no
/// reason for a warning that something is missing.
class StartGrace {
 public:
  using Time = std::chrono::steady_clock::time_point;
  /// Drivers in Python need 1 to 3 s on a busy computer until they publish what the node waits for.
  static constexpr std::chrono::seconds kLength{5};

  explicit StartGrace(Time started = std::chrono::steady_clock::now()) : end_(started + kLength) {}

  Time end() const { return end_; }
  /// Whether a refusal with this code at this time may be only the effect of a start.
  bool excuses(Code code, Time now) const;
  /// Counts and logs a refused map, or a refused message of a sensor or a tracker. Does not log what excuses() excuses.
  void refuse(Ledger& ledger, const std::string& where, const Refusal& refusal) const;

 private:
  Time end_;
};

}  // namespace hgrid
