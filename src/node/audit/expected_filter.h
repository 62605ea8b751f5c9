// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

#include <cstdint>

#include "node/audit/audit_case.h"

namespace hgrid {

/// Computes from the rules and margins of a case which pairs of bodies are reported, and with which margin. Uses no
/// code of the folder pairs, which the audit checks. It compares a pair with every rule, which is slow. So use it only
/// for near pairs.
class ExpectedFilter {
 public:
  explicit ExpectedFilter(const AuditCase& audited) : audited_(audited) {}

  /// Whether the pair is reported if the two bodies are near.
  bool reports(std::uint32_t first, std::uint32_t second) const;
  /// Returns the margin [m] that the pair must have at least, including its growth for stale bodies.
  double marginOf(std::uint32_t first, std::uint32_t second) const;
  /// Returns a bound [m] for the margins of a body. The margin of a pair is at most the sum of the bounds of its
  /// bodies.
  double mostOf(std::uint32_t body) const;
  /// Returns how much [m] the margins of a body grow because its pose is old.
  double growthOf(std::uint32_t body) const;
  /// Returns how much [m] the node grows the boxes of a body before it searches, without the horizon.
  double shareOf(std::uint32_t body) const;

 private:
  bool exists(std::uint32_t first, std::uint32_t second) const;
  const AuditCase& audited_;
};

}  // namespace hgrid
