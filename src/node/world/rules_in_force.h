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

/// Rules for what may touch attached obstacles (Origin::attached).
struct TouchRules {
  std::vector<PairRule> rules;
  std::uint64_t revision = 0;  ///< grows with each change of the rules
};

/// Keeps the scene's rules for allowed pairs up to date: passes on new rules and removes expired ones. The rules of
/// attached obstacles come after the configured rules and before those of ~set_allowed.
class RulesInForce {
 public:
  /// Replaces all rules, apart from those of attached obstacles. The next apply() passes them to the scene.
  void set(PreparedRules rules) { next_ = std::move(rules); }
  /// Passes new rules to the scene, and removes the scene's expired rules. If this throws, the next call tries again.
  void apply(const Moment& now, const TouchRules& touch, Scene& scene) {
    const std::vector<PairRule>& given = next_ ? next_->filter.rules() : scene.rules();
    if ((next_ || touch_revision_ != touch.revision) && !has(given, touch.rules)) {
      scene.setRules(merged(given, touch.rules));
    } else if (next_) {
      scene.setPreparedRules(*next_);
    }
    touch_revision_ = touch.revision;
    next_.reset();
    const auto has_ended = [&](const PairRule& rule) { return rule.ends <= now.steady; };
    const std::vector<PairRule>& rules = scene.rules();
    if (std::none_of(rules.begin(), rules.end(), has_ended)) return;
    std::vector<bool> gone(rules.size());
    std::transform(rules.begin(), rules.end(), gone.begin(), has_ended);
    scene.removeRules(gone);
  }

 private:
  static bool isTouch(const PairRule& rule) { return rule.origin == Origin::attached; }
  /// Returns whether the rules of attached obstacles in `rules` equal `touch`.
  static bool has(const std::vector<PairRule>& rules, const std::vector<PairRule>& touch) {
    const auto first = std::find_if(rules.begin(), rules.end(), isTouch);
    const auto last = std::find_if_not(first, rules.end(), isTouch);
    return std::equal(first, last, touch.begin(), touch.end(), [](const PairRule& a, const PairRule& b) {
      return a.first == b.first && a.second == b.second && a.reason == b.reason;
    });
  }
  /// Returns `rules` with its rules of attached obstacles replaced by `touch`.
  static std::vector<PairRule> merged(std::vector<PairRule> rules, const std::vector<PairRule>& touch) {
    rules.erase(std::remove_if(rules.begin(), rules.end(), isTouch), rules.end());
    const auto isAdded = [](const PairRule& rule) { return rule.origin == Origin::service; };
    rules.insert(std::find_if(rules.begin(), rules.end(), isAdded), touch.begin(), touch.end());
    return rules;
  }

  std::optional<PreparedRules> next_;
  std::uint64_t touch_revision_ = 0;
};

}  // namespace hgrid
