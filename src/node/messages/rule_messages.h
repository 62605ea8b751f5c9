// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

#include <hgrid_proximity/AllowedPair.h>

#include <vector>

#include "hgrid_proximity/pairs/pair_rule.h"

namespace hgrid {

namespace msg = ::hgrid_proximity;

/// Rules of ~set_allowed; their lifetimes begin at `now`.
/// @throws Refusal bad_id, out_of_range
std::vector<PairRule> rulesOf(const std::vector<msg::AllowedPair>& pairs, PairRule::Clock::time_point now);

msg::AllowedPair toMsg(const PairRule& rule, PairRule::Clock::time_point now);

}  // namespace hgrid
