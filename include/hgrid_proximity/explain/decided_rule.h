// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

#include <utility>

#include "hgrid_proximity/world/snapshot.h"

namespace hgrid {

/// Returns the rule that decides about a pair of bodies. If a rule of a user decides, returns this rule unchanged, with
/// its globs. If something else decides, for example an SRDF, returns a rule with the names of the two bodies.
inline PairRule decidedRule(const Structure& structure, std::uint32_t first, std::uint32_t second) {
  PairDecision decision = structure.filter.decision(first, second);
  if (decision.rule != PairDecision::kNoRule) return structure.filter.rules()[decision.rule];
  PairRule rule;
  rule.first = structure.bodies[first].name;
  rule.second = structure.bodies[second].name;
  rule.reason = std::move(decision.reason);
  rule.allowed = decision.allowed;
  rule.origin = decision.origin;
  return rule;
}

}  // namespace hgrid
