// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

#include <chrono>
#include <string>
#include <vector>

#include "hgrid_proximity/bodies/body_list.h"
#include "hgrid_proximity/bodies/link_matrix.h"

namespace hgrid {

/// One rule of the allowed collision matrix, for two body names or for all pairs that match two globs, in either order.
///
/// In a list of rules, a rule for two names takes precedence over a rule with a glob. If two rules are equally exact in
/// this sense, the later one takes precedence. Every rule takes precedence over the models of the robots.
struct PairRule {
  /// The clock for the end of a rule. Setting the system time does not change it.
  using Clock = std::chrono::steady_clock;

  std::string first;   ///< name of one body, or a glob over body names
  std::string second;  ///< name of the other body, or a glob over body names
  std::string reason;  ///< reason for the rule, shown to users
  /// True: the bodies may touch, so their pair is not reported. False: the pair is reported.
  bool allowed = true;
  Origin origin = Origin::parameter;                  ///< where the rule comes from
  Clock::time_point ends = Clock::time_point::max();  ///< when the rule ends; max: never
  std::string set_by = {};                            ///< who set the rule at run time; empty for other rules
  Time since{0};                                      ///< when the rule was set at run time; 0 for other rules

  /// Whether both rules are equal in all members.
  bool operator==(const PairRule& other) const;
  /// Whether the rules differ in at least one member.
  bool operator!=(const PairRule& other) const { return !(*this == other); }
};

/// Maximum length [bytes] of each name, glob and reason in a rule.
inline constexpr std::size_t kLongestRuleText = 512;

/// Returns whether a name is a glob, that is, contains a `*`. No other character has a special meaning.
bool isGlob(const std::string& name);

/// Checks the names and the reason of a rule: their length and that they are printable UTF-8.
/// @throws Refusal bad_id if a name is not valid, out_of_range if the reason is not valid
void checkRule(const PairRule& rule);

/// Checks that every name in the rules is the name of a body, and that every glob matches at least one body.
/// @throws Refusal unknown_id if not; its sentence has the missing name and the most similar existing names
void checkKnown(const std::vector<PairRule>& rules, const BodyList& bodies);

}  // namespace hgrid
