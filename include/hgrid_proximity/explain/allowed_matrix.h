// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "hgrid_proximity/world/snapshot.h"

namespace hgrid {

/// Selects a part of the allowed collision matrix.
struct AllowedScope {
  std::string first;      ///< glob over one name of a pair; empty: all names
  std::string second;     ///< glob over the other name of the pair; empty: all names
  std::size_t limit = 0;  ///< maximum number of entries
};

/// A part of the allowed collision matrix.
struct AllowedList {
  std::vector<PairRule> entries;  ///< the entries of the matrix, at most AllowedScope::limit of them
  std::uint64_t total = 0;  ///< number of all entries in the scope; larger than entries.size() if the limit cut them
};

/// Lists the pairs of bodies about which a rule, an SRDF, a joint or a rigid group decides, sorted by the two names.
/// Each entry holds the two names, the smaller one first, and the origin, reason, end, author and time of the decision.
/// Pairs whose kind does not exist (PairKinds) are left out.
/// @throws Refusal budget if too many pairs would have to be examined
AllowedList decidedPairs(const Structure& structure, const AllowedScope& scope);

/// Lists the rules as they were given, in their order. The globs of the scope are compared with the texts of the rules.
AllowedList givenRules(const Structure& structure, const AllowedScope& scope);

/// Returns a text in which the characters that XML reserves are written as XML wants them in an attribute.
std::string xmlEscaped(const std::string& text);

/// Writes the entries that name two links of one robot as SRDF: one `<robot>` element for each robot, sorted by the
/// names of the robots in the scene. The name of the element is the one that the URDF gives the robot, so that other
/// programs accept the text. Each element contains disable_collisions and enable_collisions tags in the order of the
/// entries.
std::string srdfOf(const Structure& structure, const std::vector<PairRule>& entries);

}  // namespace hgrid
