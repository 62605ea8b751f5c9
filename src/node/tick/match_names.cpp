// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#include "node/tick/match_names.h"

#include <algorithm>
#include <cstddef>
#include <utility>

#include "hgrid_proximity/bodies/name.h"

namespace hgrid {
namespace {

/// Fewer names than this are matched in the tick. With 1000 rules, that takes about 2 ms.
constexpr std::size_t kFewestNames = 50;

bool hasGlob(const PairRule& rule) { return isGlob(rule.first) || isGlob(rule.second); }

}  // namespace

std::shared_ptr<NameMatches> matchNames(std::vector<std::string> names, const PairFilter& filter) {
  const std::vector<PairRule>& rules = filter.rules();
  if (names.size() < kFewestNames || std::none_of(rules.begin(), rules.end(), hasGlob)) return nullptr;
  return std::make_shared<NameMatches>(filter.match(std::move(names)));
}

std::shared_ptr<NameMatches> matchNames(std::vector<std::string> names, const std::shared_ptr<const Tick>& newest) {
  if (!newest || !newest->snapshot) return nullptr;
  return matchNames(std::move(names), newest->snapshot->structure().filter);
}

}  // namespace hgrid
