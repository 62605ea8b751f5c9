// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

#include <cstddef>
#include <vector>

#include "hgrid_proximity/pairs/pair_rule.h"

namespace hgrid {

/// The rules in force: the configured ones (Origin::parameter) first, then those that came later (Origin::service) in
/// the order in which they came, so that of two the later one is the stronger. A value; what is refused changes
/// nothing.
class RuleBook {
 public:
  /// @param most  rules that it may hold
  explicit RuleBook(std::vector<PairRule> rules = {}, std::size_t most = 1000);

  const std::vector<PairRule>& rules() const { return rules_; }

  /// Adds rules as Origin::service. Of those that came before, the ones that say something of the same two names or
  /// globs and do not outlive the new one are dropped, since they can never decide again.
  /// @throws Refusal bad_id, out_of_range as checkRule(), limit
  void add(const std::vector<PairRule>& rules);
  /// Removes what came later and speaks of the same two names or globs as one of these, in either order.
  /// @throws Refusal unknown_id if there is no such rule
  void remove(const std::vector<PairRule>& rules);
  /// Drops the rules that have ended. @returns whether there were any
  bool expire(PairRule::Clock::time_point now);

 private:
  std::vector<PairRule> rules_;
  std::size_t most_;
};

}  // namespace hgrid
