// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

#include <chrono>
#include <string>
#include <vector>

#include "hgrid_proximity/bodies/body.h"
#include "hgrid_proximity/bodies/link_matrix.h"

namespace hgrid {

/// One rule of the allowed-pair matrix: for two bodies, or for all pairs that match two globs, in either order.
///
/// In a list of rules, a rule for two names takes precedence over a rule with a glob, and of two that are equally exact
/// the later one over the earlier one. Every rule takes precedence over the robots' models.
struct PairRule {
  using Clock = std::chrono::steady_clock;

  std::string first, second;  ///< body names or globs over body names
  std::string reason;         ///< for people
  bool allowed = true;  ///< true: the pair may touch and is not reported; false: reported in spite of weaker rules
  Origin origin = Origin::parameter;                  ///< where it comes from
  Clock::time_point ends = Clock::time_point::max();  ///< when it ends; max: never
  std::string set_by = {};                                 ///< who set it at run time; empty for rules of other origins
  Time since{0};                                      ///< when that was; 0 for rules of other origins
};

/// Most bytes of a rule's names and globs, and of its reason.
inline constexpr std::size_t kLongestRuleText = 512;

/// Whether a name is a pattern: has a `*` or a `?`.
bool isGlob(const std::string& name);

/// Checks what a rule says by itself: its texts.
/// @throws Refusal bad_id, out_of_range
void checkRule(const PairRule& rule);

/// Checks that every name is one of a body and every glob matches one.
/// @throws Refusal unknown_id, naming what is not there and what is called nearly so
void checkKnown(const std::vector<PairRule>& rules, const std::vector<Body>& bodies);

}  // namespace hgrid
