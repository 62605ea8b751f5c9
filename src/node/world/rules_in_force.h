// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

#include <algorithm>
#include <optional>
#include <utility>
#include <vector>

#include "hgrid_proximity/world/scene.h"
#include "node/time/clock_watch.h"

namespace hgrid {

/// Keeps the scene's rules for allowed pairs up to date: passes on new rules and removes expired ones.
class RulesInForce {
 public:
  /// Replaces all rules. The next apply() passes them to the scene.
  void set(PreparedRules rules) { next_ = std::move(rules); }
  /// Passes new rules to the scene, and removes the scene's expired rules. If this throws, the next call tries again.
  void apply(const Moment& now, Scene& scene) {
    if (next_) scene.setPreparedRules(*next_);
    next_.reset();
    const auto has_ended = [&](const PairRule& rule) { return rule.ends <= now.steady; };
    const std::vector<PairRule>& rules = scene.rules();
    if (std::none_of(rules.begin(), rules.end(), has_ended)) return;
    std::vector<bool> gone(rules.size());
    std::transform(rules.begin(), rules.end(), gone.begin(), has_ended);
    scene.removeRules(gone);
  }

 private:
  std::optional<PreparedRules> next_;
};

}  // namespace hgrid
