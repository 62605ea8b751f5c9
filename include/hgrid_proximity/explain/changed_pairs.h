// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

#include <cstdint>
#include <vector>

#include "hgrid_proximity/bodies/body.h"
#include "hgrid_proximity/pairs/pair_filter.h"

namespace hgrid {

/// Counts the pairs of bodies that a change of the rules has switched off or on: one filter allows them to touch, the
/// other does not.
///
/// The function looks only at bodies that match a rule of just one of the filters. It examines bodies that all rules
/// treat alike only once, so rules with globs take no longer than it took to create the filters. It compares links of
/// one robot pair by pair.
/// @param bodies  the bodies that both filters were created from
/// @param before  the filter before the change
/// @param after   the filter after the change
std::uint64_t changedPairs(const std::vector<Body>& bodies, const PairFilter& before, const PairFilter& after);

}  // namespace hgrid
