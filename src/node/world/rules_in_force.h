// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

#include <utility>
#include <vector>

#include "hgrid_proximity/pairs/rule_book.h"
#include "hgrid_proximity/world/scene.h"
#include "node/time/clock_watch.h"

namespace hgrid {

/// Keeps the scene's rules of the allowed-pair matrix up to date: new ones are set, expired ones are removed.
class RulesInForce {
 public:
  /// @param rules  those that the scene has already
  explicit RulesInForce(std::vector<PairRule> rules) : book_(std::move(rules)) {}

  /// Replaces all rules. The next apply() hands them to the scene.
  void set(std::vector<PairRule> rules) {
    book_ = RuleBook(std::move(rules));
    changed_ = true;
  }
  /// Gives the scene the rules in force, if they changed. If that throws, the next call does it.
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
