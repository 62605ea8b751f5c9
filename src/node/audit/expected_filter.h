// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

#include <cstdint>

#include "node/audit/audit_case.h"

namespace hgrid {

/// Decides which pairs of bodies are reported and at which margin, directly from the rules. Written apart from the
/// folder pairs, which the audit checks. It looks at each rule for each pair, so ask it only about near pairs.
class ExpectedFilter {
 public:
  explicit ExpectedFilter(const AuditCase& audited) : audited_(audited) {}

  /// Whether the pair is reported if the two bodies are near.
  bool reports(std::uint32_t first, std::uint32_t second) const;
  /// Returns the margin [m] of the pair, including its growth for stale bodies.
  double marginOf(std::uint32_t first, std::uint32_t second) const;
  /// Returns a length [m] that no margin of the body exceeds.
  double mostOf(std::uint32_t body) const;

 private:
  bool exists(std::uint32_t first, std::uint32_t second) const;
  double growthOf(std::uint32_t body) const;
  const AuditCase& audited_;
};

}  // namespace hgrid
