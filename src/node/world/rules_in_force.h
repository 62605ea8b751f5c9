// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

#include <utility>
#include <vector>

#include "hgrid_proximity/pairs/rule_book.h"
#include "hgrid_proximity/world/scene.h"
#include "node/time/clock_watch.h"

namespace hgrid {

/// Keeps the scene's rules for allowed pairs up to date: passes on new rules and removes expired ones.
class RulesInForce {
 public:
  /// @param rules  the rules that the scene already has
  explicit RulesInForce(std::vector<PairRule> rules) : book_(std::move(rules)) {}

  /// Replaces all rules. The next apply() passes them to the scene.
  void set(std::vector<PairRule> rules) {
    book_ = RuleBook(std::move(rules));
    changed_ = true;
  }
  /// Passes the current rules to the scene, if they changed. If this throws, the next call tries again.
  void apply(const Moment& now, Scene& scene) {
    if (book_.expire(now.steady)) changed_ = true;
    if (!changed_) return;
    scene.setRules(book_.rules());
    changed_ = false;
  }

 private:
  RuleBook book_;
  bool changed_ = false;
};

}  // namespace hgrid
