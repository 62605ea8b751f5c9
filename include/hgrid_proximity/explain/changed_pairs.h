// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

#include <cstdint>
#include <vector>

#include "hgrid_proximity/bodies/body.h"
#include "hgrid_proximity/pairs/pair_filter.h"

namespace hgrid {

/// Number of pairs of bodies that one filter allows and the other does not: those that a change of the rules has
/// switched off or on.
///
/// Looks only at bodies that a rule matches which only one of the filters has. Bodies that all rules treat alike are
/// looked at as one, so that rules with globs take no longer than the filters themselves took. Links of one robot are
/// looked at pair by pair.
/// @param bodies  what both filters were made from
std::uint64_t changedPairs(const std::vector<Body>& bodies, const PairFilter& before, const PairFilter& after);

}  // namespace hgrid
