// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#include "node/world/rules_in_force.h"

#include <algorithm>

namespace hgrid {
namespace {

bool isSameDerived(const PairRule& a, const PairRule& b) {
  return a.first == b.first && a.second == b.second && a.reason == b.reason && a.allowed == b.allowed;
}

/// Returns `rules` without those of this origin.
std::vector<PairRule> without(std::vector<PairRule> rules, Origin origin) {
  const auto is_gone = [origin](const PairRule& rule) { return rule.origin == origin; };
  rules.erase(std::remove_if(rules.begin(), rules.end(), is_gone), rules.end());
  return rules;
}

/// Sets `gone` for each rule of this origin that `derived` lacks.
/// @returns whether `rules` has all rules of `derived`, in this order
bool markMissing(const std::vector<PairRule>& rules, Origin origin, const std::vector<PairRule>& derived,
                 std::vector<bool>& gone) {
  auto next = derived.begin();
  for (std::size_t i = 0; i < rules.size(); ++i) {
    if (rules[i].origin != origin) continue;
    if (next != derived.end() && isSameDerived(rules[i], *next)) {
      ++next;
    } else {
      gone[i] = true;
    }
  }
  return next == derived.end();
}

}  // namespace

bool hasDerived(const std::vector<PairRule>& rules, Origin origin, const std::vector<PairRule>& derived) {
  const auto is_one = [origin](const PairRule& rule) { return rule.origin == origin; };
  const auto first = std::find_if(rules.begin(), rules.end(), is_one);
  const auto last = std::find_if_not(first, rules.end(), is_one);
  return std::equal(first, last, derived.begin(), derived.end(), isSameDerived);
}

std::vector<PairRule> withTouchRules(std::vector<PairRule> rules, const std::vector<PairRule>& touch) {
  rules = without(std::move(rules), Origin::attached);
  const auto is_added = [](const PairRule& rule) { return rule.origin == Origin::service; };
  rules.insert(std::find_if(rules.begin(), rules.end(), is_added), touch.begin(), touch.end());
  return rules;
}

std::vector<PairRule> withMoveItRules(std::vector<PairRule> rules, const std::vector<PairRule>& moveit) {
  rules = without(std::move(rules), Origin::moveit);
  rules.insert(rules.begin(), moveit.begin(), moveit.end());
  return rules;
}

/// Passes new rules to the scene. If no derived rule is new, only removes those that ended, which takes much less time.
void RulesInForce::update(const DerivedRules& touch, const DerivedRules& moveit, Scene& scene) const {
  const std::vector<PairRule>& given = next_ ? next_->filter.rules() : scene.rules();
  if (hasDerived(given, Origin::attached, touch.rules) && hasDerived(given, Origin::moveit, moveit.rules)) {
    if (next_) scene.setPreparedRules(*next_);
    return;
  }
  std::vector<bool> gone(given.size());
  if (!next_ && markMissing(given, Origin::attached, touch.rules, gone) &&
      markMissing(given, Origin::moveit, moveit.rules, gone)) {
    return scene.removeRules(gone);
  }
  scene.setRules(withMoveItRules(withTouchRules(given, touch.rules), moveit.rules));
}

void RulesInForce::apply(const Moment& now, const DerivedRules& touch, const DerivedRules& moveit, Scene& scene) {
  if (next_ || touch_revision_ != touch.revision || moveit_revision_ != moveit.revision) update(touch, moveit, scene);
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

}  // namespace hgrid
