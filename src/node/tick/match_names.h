// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "hgrid_proximity/pairs/pair_filter.h"
#include "node/tick/tick.h"

namespace hgrid {

/// Matches the names of bodies that a change will add with the rules for allowed pairs, so that the tick that makes the
/// change need not do it. Takes long if there are many names and rules. The tick thread must not call this.
/// @returns what World::prepareNames() takes; null if there are few names or no globs
std::shared_ptr<NameMatches> matchNames(std::vector<std::string> names, const PairFilter& filter);

/// Matches the names with the rules of the newest tick. @returns null also if `newest` is null or has no snapshot
std::shared_ptr<NameMatches> matchNames(std::vector<std::string> names, const std::shared_ptr<const Tick>& newest);

}  // namespace hgrid
