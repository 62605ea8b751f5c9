// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

#include <cstdint>
#include <optional>
#include <utility>
#include <vector>

#include "hgrid_proximity/world/scene.h"
#include "node/time/clock_watch.h"

namespace hgrid {

/// Rules that follow from something else: from attached obstacles (Origin::attached), or from an allowed collision
/// matrix of MoveIt (Origin::moveit).
struct DerivedRules {
  std::vector<PairRule> rules;
  std::uint64_t revision = 0;  ///< grows with each change of the rules
};

/// Returns whether the rules of this origin in `rules` are those in `derived`, in the same order, and whether no other
/// rules are between them.
bool hasDerived(const std::vector<PairRule>& rules, Origin origin, const std::vector<PairRule>& derived);

/// Returns `rules` with its rules for attached obstacles replaced by `touch`. See RulesInForce for the order.
std::vector<PairRule> withTouchRules(std::vector<PairRule> rules, const std::vector<PairRule>& touch);

/// Returns `rules` with its rules of MoveIt replaced by `moveit`. See RulesInForce for the order.
std::vector<PairRule> withMoveItRules(std::vector<PairRule> rules, const std::vector<PairRule>& moveit);

/// Keeps the scene's rules for allowed pairs up to date: passes on new rules and removes expired ones. The rules of
/// MoveIt come first, so that every other rule takes precedence over an equally exact one of them. The rules of
/// attached obstacles come after the configured rules and before those of ~set_allowed.
class RulesInForce {
 public:
  /// Replaces all rules, apart from the derived ones. The next apply() passes them to the scene.
  void set(PreparedRules rules) { next_ = std::move(rules); }
  /// Passes new rules to the scene, and removes the scene's expired rules. If this throws, the next call tries again.
  void apply(const Moment& now, const DerivedRules& touch, const DerivedRules& moveit, Scene& scene);

 private:
  void update(const DerivedRules& touch, const DerivedRules& moveit, Scene& scene) const;

  std::optional<PreparedRules> next_;
  std::uint64_t touch_revision_ = 0, moveit_revision_ = 0;
};

}  // namespace hgrid
