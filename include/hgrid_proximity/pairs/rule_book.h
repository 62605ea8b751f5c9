// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

#include <cstddef>
#include <vector>

#include "hgrid_proximity/pairs/pair_rule.h"

namespace hgrid {

/// The rules in force: first the configured rules (Origin::parameter), then the rules added at run time
/// (Origin::service) in the order in which they were added. If two equally exact rules match a pair, the later one
/// decides. A value type. A call that throws changes nothing.
class RuleBook {
 public:
  /// @param most  maximum number of rules, including the configured ones
  explicit RuleBook(std::vector<PairRule> rules = {}, std::size_t most = 1000);

  /// Returns the rules in force, in their order.
  const std::vector<PairRule>& rules() const { return rules_; }

  /// Adds rules as Origin::service. Drops an older rule of Origin::service if a new rule has the same two names or
  /// globs and does not end earlier, because the older rule can never decide again.
  /// @throws Refusal bad_id or out_of_range as checkRule() does; limit if there would be too many rules
  void add(const std::vector<PairRule>& rules);
  /// Removes the rules of Origin::service that have the same two names or globs as one of `rules`, in either order.
  /// @throws Refusal unknown_id if there is no such rule for one of `rules`
  void remove(const std::vector<PairRule>& rules);

 private:
  std::vector<PairRule> rules_;
  std::size_t most_;
};

}  // namespace hgrid
