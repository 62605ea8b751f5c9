// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

#include <cstdint>
#include <vector>

#include "hgrid_proximity/bodies/body_list.h"
#include "hgrid_proximity/pairs/pair_filter.h"

namespace hgrid {

/// Counts the pairs of bodies that a change of the rules has switched off or on: exactly one of the two filters
/// switches off such a pair.
///
/// The function looks only at bodies that match a rule in which the filters differ. If all rules treat several bodies
/// alike, it examines these bodies only once. So rules with globs take no longer than it took to create the filters.
/// The function compares links of one robot pair by pair.
/// @param bodies  the bodies that both filters were created from
/// @param before  the filter before the change
/// @param after   the filter after the change
std::uint64_t changedPairs(const BodyList& bodies, const PairFilter& before, const PairFilter& after);

}  // namespace hgrid
