// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "hgrid_proximity/world/snapshot.h"

namespace hgrid {

/// What part of the allowed-pair matrix is asked for.
struct AllowedScope {
  std::string first, second;  ///< globs over the two names, in either order; empty: all
  std::size_t limit = 0;      ///< most entries
};

/// A part of the allowed-pair matrix, sorted by the two names.
struct AllowedList {
  std::vector<PairRule> entries;
  std::uint64_t total = 0;  ///< how many there are; more than entries if there was a limit
};

/// Pairs of bodies that a rule, an SRDF, a joint or a rigid group speaks of, each with what decides: the two names, the
/// smaller first, and origin, reason, end, who set it and when. Pairs that do not exist (PairKinds) are none of them.
/// @throws Refusal budget if it would take too many looks
AllowedList decidedPairs(const Structure& structure, const AllowedScope& scope);

/// The rules as they were given; globs of the scope are compared with their texts.
AllowedList givenRules(const Structure& structure, const AllowedScope& scope);

/// The entries that name two links of one robot as SRDF: a <robot> element for each, with disable_collisions and
/// enable_collisions in the order of the entries.
std::string srdfOf(const Structure& structure, const std::vector<PairRule>& entries);

}  // namespace hgrid
