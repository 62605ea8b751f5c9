// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

#include <algorithm>
#include <string>
#include <unordered_map>

#include "hgrid_proximity/refusal.h"
#include "node/audit/audit_case.h"

namespace hgrid {

/// Finds the pairs that the node listed.
class ListedPairs {
 public:
  explicit ListedPairs(const AuditCase& audited) : audited_(audited) {
    for (const NearPair& pair : audited.pairs) pairs_.emplace(keyOf(pair.first, pair.second), &pair);
  }

  /// Returns the pair; null if the node did not list it.
  const NearPair* find(std::uint32_t first, std::uint32_t second) const {
    const auto found = pairs_.find(keyOf(first, second));
    return found == pairs_.end() ? nullptr : found->second;
  }
  /// Returns the names of a pair for a sentence.
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
