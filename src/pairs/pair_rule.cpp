// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#include "hgrid_proximity/pairs/pair_rule.h"

#include "bodies/name_index.h"
#include "bodies/nearest_names.h"
#include "hgrid_proximity/bodies/name.h"
#include "hgrid_proximity/refusal.h"
#include "utf8.h"

namespace hgrid {
namespace {

/// Returns whether the text is valid UTF-8 without control characters.
bool isPrintable(const std::string& text) {
  for (std::size_t i = 0; i < text.size();) {
    const std::size_t length = utf8Length(text, i);
    if (length == 0) return false;
    i += length;
  }
  return true;
}

void checkName(const std::string& name, const char* what) {
  const auto refuse = [&](const std::string& rule) {
    throw Refusal(Code::bad_id, std::string(what) + " name of a rule is '" + printable(name, 48) + "'; " + rule);
  };
  if (name.empty()) refuse("it must not be empty");
  if (name.size() > kLongestRuleText) {
    refuse("it has " + std::to_string(name.size()) + " bytes; at most " + std::to_string(kLongestRuleText) +
           " are allowed");
  }
  if (!isPrintable(name)) refuse("it must be UTF-8 without control characters");
}

}  // namespace

bool PairRule::operator==(const PairRule& other) const {
  return first == other.first && second == other.second && reason == other.reason && allowed == other.allowed &&
         origin == other.origin && ends == other.ends && set_by == other.set_by && since == other.since;
}

bool isGlob(const std::string& name) { return name.find('*') != std::string::npos; }

void checkRule(const PairRule& rule) {
  checkName(rule.first, "first");
  checkName(rule.second, "second");
  const std::string what = "the reason of rule '" + rule.first + "', '" + rule.second + "'";
  if (rule.reason.size() > kLongestRuleText) {
    throw Refusal(Code::out_of_range, what + " has " + std::to_string(rule.reason.size()) + " bytes; at most " +
                                          std::to_string(kLongestRuleText) + " are allowed");
  }
  if (!isPrintable(rule.reason)) {
    throw Refusal(Code::out_of_range,
                  what + " is '" + printable(rule.reason, 48) + "'; it must be UTF-8 without control characters");
  }
}

void checkKnown(const std::vector<PairRule>& rules, const BodyList& bodies) {
  const NameIndex names(bodies);
  for (const PairRule& rule : rules) {
    for (const std::string* name : {&rule.first, &rule.second}) {
      if (isGlob(*name)) {
        if (names.matchesNone(*name))
          throw Refusal(Code::unknown_id,
                        "no body matches the glob '" + *name + "'; a rule needs at least one matching body");
      } else if (names.find(*name) == NameIndex::kNone) {
        throw Refusal(Code::unknown_id, noSuchBody(*name, bodies));
      }
    }
  }
}

}  // namespace hgrid
