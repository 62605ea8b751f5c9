// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

#include <algorithm>
#include <string>
#include <unordered_map>

#include "hgrid_proximity/refusal.h"
#include "node/audit/audit_case.h"

namespace hgrid {

/// Finds pairs by their bodies in the list of pairs of a tick.
class ListedPairs {
 public:
  explicit ListedPairs(const AuditCase& audited) : audited_(audited) {
    for (const NearPair& pair : audited.pairs) pairs_.emplace(keyOf(pair.first, pair.second), &pair);
  }

  /// Returns the pair of two bodies; null if the tick does not list it.
  const NearPair* find(std::uint32_t first, std::uint32_t second) const {
    const auto found = pairs_.find(keyOf(first, second));
    return found == pairs_.end() ? nullptr : found->second;
  }
  /// Returns a pair as words for a sentence: `the pair 'a', 'b'`.
  std::string nameOf(std::uint32_t first, std::uint32_t second) const {
    return "the pair '" + printable(audited_.bodies[first].name) + "', '" + printable(audited_.bodies[second].name) +
           "'";
  }

 private:
  static std::uint64_t keyOf(std::uint32_t first, std::uint32_t second) {
    return std::uint64_t{std::min(first, second)} << 32 | std::max(first, second);
  }

  const AuditCase& audited_;
  std::unordered_map<std::uint64_t, const NearPair*> pairs_;
};

}  // namespace hgrid
