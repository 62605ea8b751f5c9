// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

#include <algorithm>
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

/// Keeps the scene's rules for allowed pairs up to date: passes on new rules and removes expired ones. The rules of
/// MoveIt come first, so that every other rule takes precedence over an equally exact one of them. The rules of
/// attached obstacles come after the configured rules and before those of ~set_allowed.
class RulesInForce {
 public:
  /// Replaces all rules, apart from the derived ones. The next apply() passes them to the scene.
  void set(PreparedRules rules) { next_ = std::move(rules); }
  /// Passes new rules to the scene, and removes the scene's expired rules. If this throws, the next call tries again.
  void apply(const Moment& now, const DerivedRules& touch, const DerivedRules& moveit, Scene& scene) {
    const std::vector<PairRule>& given = next_ ? next_->filter.rules() : scene.rules();
    const bool may_differ = next_ || touch_revision_ != touch.revision || moveit_revision_ != moveit.revision;
    if (may_differ && !(has(given, Origin::attached, touch.rules) && has(given, Origin::moveit, moveit.rules))) {
      scene.setRules(merged(given, touch.rules, moveit.rules));
    } else if (next_) {
      scene.setPreparedRules(*next_);
    }
    touch_revision_ = touch.revision;
    moveit_revision_ = moveit.revision;
    next_.reset();
    const auto has_ended = [&](const PairRule& rule) { return rule.ends <= now.steady; };
    const std::vector<PairRule>& rules = scene.rules();
    if (std::none_of(rules.begin(), rules.end(), has_ended)) return;
    std::vector<bool> gone(rules.size());
    std::transform(rules.begin(), rules.end(), gone.begin(), has_ended);
    scene.removeRules(gone);
  }

 private:
  static bool isDerived(const PairRule& rule) {
    return rule.origin == Origin::attached || rule.origin == Origin::moveit;
  }
  /// Returns whether the rules of this origin in `rules` are those of `derived`, one after the other.
  static bool has(const std::vector<PairRule>& rules, Origin origin, const std::vector<PairRule>& derived) {
    const auto is_one = [origin](const PairRule& rule) { return rule.origin == origin; };
    const auto first = std::find_if(rules.begin(), rules.end(), is_one);
    const auto last = std::find_if_not(first, rules.end(), is_one);
    return std::equal(first, last, derived.begin(), derived.end(), [](const PairRule& a, const PairRule& b) {
      return a.first == b.first && a.second == b.second && a.reason == b.reason && a.allowed == b.allowed;
    });
  }
  /// Returns `rules` with its derived rules replaced.
  static std::vector<PairRule> merged(std::vector<PairRule> rules, const std::vector<PairRule>& touch,
                                      const std::vector<PairRule>& moveit) {
    rules.erase(std::remove_if(rules.begin(), rules.end(), isDerived), rules.end());
    const auto isAdded = [](const PairRule& rule) { return rule.origin == Origin::service; };
    rules.insert(std::find_if(rules.begin(), rules.end(), isAdded), touch.begin(), touch.end());
    rules.insert(rules.begin(), moveit.begin(), moveit.end());
    return rules;
  }

  std::optional<PreparedRules> next_;
  std::uint64_t touch_revision_ = 0, moveit_revision_ = 0;
};

}  // namespace hgrid
