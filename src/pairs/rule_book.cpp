// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#include "hgrid_proximity/pairs/rule_book.h"

#include <algorithm>
#include <map>
#include <set>
#include <utility>

#include "hgrid_proximity/refusal.h"

namespace hgrid {
namespace {

using Names = std::pair<std::string, std::string>;

/// Returns the two names or globs of a rule in alphabetical order.
Names namesOf(const PairRule& rule) { return std::minmax(rule.first, rule.second); }

std::string shown(const PairRule& rule) { return "'" + printable(rule.first) + "', '" + printable(rule.second) + "'"; }

}  // namespace

RuleBook::RuleBook(std::vector<PairRule> rules, std::size_t most) : rules_(std::move(rules)), most_(most) {}

void RuleBook::add(const std::vector<PairRule>& rules) {
  std::vector<PairRule> all = rules_;
  for (PairRule rule : rules) {
    checkRule(rule);
    rule.origin = Origin::service;
    all.push_back(std::move(rule));
  }
  std::map<Names, PairRule::Clock::time_point> decided;  // for two names: the end of the later rules for them
  std::vector<PairRule> kept;
  for (auto rule = all.rbegin(); rule != all.rend(); ++rule) {
    if (rule->origin == Origin::service) {
      const auto later = decided.emplace(namesOf(*rule), rule->ends);
      if (!later.second && rule->ends <= later.first->second) continue;
      later.first->second = rule->ends;
    }
    kept.push_back(std::move(*rule));
  }
  const auto is_counted = [](const PairRule& rule) {
    return rule.origin != Origin::attached && rule.origin != Origin::moveit;  // they have limits of their own
  };
  const auto count = std::count_if(kept.begin(), kept.end(), is_counted);
  if (static_cast<std::size_t>(count) > most_) {
    throw Refusal(Code::limit, "there would be " + std::to_string(count) +
                                   " rules, including the configured ones; at most " + std::to_string(most_) +
                                   " are allowed (max_rules)");
  }
  std::reverse(kept.begin(), kept.end());
  rules_ = std::move(kept);
}

void RuleBook::remove(const std::vector<PairRule>& rules) {
  std::set<Names> given, wanted;
  for (const PairRule& rule : rules_) {
    if (rule.origin == Origin::service) given.insert(namesOf(rule));
  }
  for (const PairRule& rule : rules) {
    wanted.insert(namesOf(rule));
    if (given.count(namesOf(rule)) != 0) continue;
    const auto other = std::find_if(rules_.begin(), rules_.end(),
                                    [&](const PairRule& known) { return namesOf(known) == namesOf(rule); });
    if (other == rules_.end()) {
      throw Refusal(Code::unknown_id, "there is no rule " + shown(rule) + "; only an existing rule can be removed");
    }
    const char* why = other->origin == Origin::attached ? "belongs to an attached obstacle"
                      : other->origin == Origin::moveit ? "came from MoveIt"
                                                        : "was configured";
    throw Refusal(Code::unknown_id,
                  "rule " + shown(rule) + " " + why + " and cannot be removed; add the same rule with allowed = false");
  }
  const auto unwanted = [&](const PairRule& rule) {
    return rule.origin == Origin::service && wanted.count(namesOf(rule)) != 0;
  };
  rules_.erase(std::remove_if(rules_.begin(), rules_.end(), unwanted), rules_.end());
}

}  // namespace hgrid
