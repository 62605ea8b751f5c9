// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

#include <hgrid_proximity/AllowedPair.h>
#include <hgrid_proximity/Rules.h>

#include <string>
#include <vector>

#include "hgrid_proximity/pairs/pair_rule.h"
#include "node/params/params.h"
#include "node/tick/tick.h"

namespace hgrid {

namespace msg = ::hgrid_proximity;

/// Converts the rules of a request to ~set_allowed. Their lifetimes begin at `now.steady`.
/// @param set_by  name of the node that sent the request
/// @throws Refusal bad_id, out_of_range
std::vector<PairRule> rulesOf(const std::vector<msg::AllowedPair>& pairs, const std::string& set_by, const Moment& now);

/// Converts a rule.
/// @param now  current time, from which the remaining lifetime of the rule is computed
msg::AllowedPair toMsg(const PairRule& rule, PairRule::Clock::time_point now);

/// Returns the message of ~rules. Before there is a world, it lists the configured rules.
msg::Rules rulesMessage(const Tick& tick, const Params& params);

}  // namespace hgrid
