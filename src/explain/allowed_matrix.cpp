// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#include "hgrid_proximity/explain/allowed_matrix.h"

#include <algorithm>
#include <iterator>
#include <map>
#include <utility>

#include "hgrid_proximity/bodies/name.h"
#include "hgrid_proximity/refusal.h"

namespace hgrid {
namespace {

constexpr std::uint64_t kMostLooks = 20000000;  // maximum number of pairs to examine; takes about a second

/// Which of the two globs of a scope a name matches.
struct Matched {
  bool first, second;
};

Matched match(const AllowedScope& scope, const std::string& name) {
  return {scope.first.empty() || matches(scope.first, name), scope.second.empty() || matches(scope.second, name)};
}

bool inScope(const Matched& a, const Matched& b) { return (a.first && b.second) || (b.first && a.second); }

/// The bodies that may have entries in the matrix: all bodies that a rule matches, and the links of each robot.
struct Circles {
  std::vector<std::uint32_t> ruled;
  std::map<std::string, std::vector<std::uint32_t>> robots;

  template <class IsOne>
  Circles(const Structure& structure, IsOne&& is_one) {
    for (std::uint32_t i = 0; i < structure.bodies.size(); ++i) {
      if (!is_one(i)) continue;
      if (structure.filter.isRuled(i)) ruled.push_back(i);
      if (structure.bodies[i].links) robots[structure.bodies[i].robot].push_back(i);
    }
  }
  /// Replaces `partners` by the bodies with a larger index that may have an entry with `body`, ascending.
  void after(const Structure& structure, std::uint32_t body, std::vector<std::uint32_t>& partners) const {
    static const std::vector<std::uint32_t> kNobody;
    const auto robot = robots.find(structure.bodies[body].robot);
    const auto& links = robot == robots.end() || !structure.bodies[body].links ? kNobody : robot->second;
    const auto& others = structure.filter.isRuled(body) ? ruled : kNobody;
    partners.clear();
    std::set_union(std::upper_bound(links.begin(), links.end(), body), links.end(),
                   std::upper_bound(others.begin(), others.end(), body), others.end(), std::back_inserter(partners));
  }
};

std::string localPart(const std::string& name) { return name.substr(name.find('/') + 1); }

}  // namespace

std::string xmlEscaped(const std::string& text) {
  std::string result;
  for (const char c : text) {
    switch (c) {
      case '&':
        result += "&amp;";
        break;
      case '<':
        result += "&lt;";
        break;
      case '>':
        result += "&gt;";
        break;
      case '"':
        result += "&quot;";
        break;
      default:
        result += c;
    }
  }
  return result;
}

AllowedList decidedPairs(const Structure& structure, const AllowedScope& scope) {
  std::vector<Matched> matched;
  for (const Body& body : structure.bodies) matched.push_back(match(scope, body.name));
  const auto count = [&](bool Matched::*by) {
    return std::count_if(matched.begin(), matched.end(), [by](const Matched& body) { return body.*by; });
  };
  // In each pair of the scope, one body matches the first glob and the other matches the second glob. `rare` is the
  // glob that fewer bodies match. So at least one body of each pair matches `rare`.
  bool Matched::*const rare = count(&Matched::first) < count(&Matched::second) ? &Matched::first : &Matched::second;
  const Circles everybody(structure, [](std::uint32_t) { return true; });
  const Circles few(structure, [&](std::uint32_t body) { return matched[body].*rare; });
  AllowedList list;
  std::vector<std::uint32_t> partners;
  std::uint64_t looks = 0;
  for (std::uint32_t i = 0; i < structure.bodies.size(); ++i) {
    if (!matched[i].first && !matched[i].second) continue;
    (matched[i].*rare ? everybody : few).after(structure, i, partners);
    looks += partners.size();
    if (looks > kMostLooks) {
      throw Refusal(Code::budget, "more than " + std::to_string(kMostLooks) +
                                      " pairs would have to be examined; use narrower globs, or ask for the rules");
    }
    for (const std::uint32_t j : partners) {
      if (!inScope(matched[i], matched[j])) continue;
      PairDecision decision = structure.filter.decision(i, j);
      if (decision.origin == Origin::none || decision.origin == Origin::kind) continue;
      if (list.total++ >= scope.limit) continue;
      PairRule entry;
      entry.first = structure.bodies[i].name;
      entry.second = structure.bodies[j].name;
      entry.reason = std::move(decision.reason);
      entry.allowed = decision.allowed;
      entry.origin = decision.origin;
      if (decision.rule != PairDecision::kNoRule) {
        const PairRule& rule = structure.filter.rules()[decision.rule];
        entry.ends = rule.ends;
        entry.set_by = rule.set_by;
        entry.since = rule.since;
      }
      list.entries.push_back(std::move(entry));
    }
  }
  return list;
}

AllowedList givenRules(const Structure& structure, const AllowedScope& scope) {
  AllowedList list;
  for (const PairRule& rule : structure.filter.rules()) {
    if (inScope(match(scope, rule.first), match(scope, rule.second))) list.entries.push_back(rule);
  }
  list.total = list.entries.size();
  if (list.entries.size() > scope.limit) list.entries.resize(scope.limit);
  return list;
}

std::string srdfOf(const Structure& structure, const std::vector<PairRule>& entries) {
  struct Element {
    const LinkMatrix* links;  // of the robot
    std::string tags;
  };
  std::map<std::string, Element> by_robot;
  for (const PairRule& entry : entries) {
    const std::uint32_t first = structure.find(entry.first), second = structure.find(entry.second);
    if (first == Structure::kNone || second == Structure::kNone) continue;
    const Body& body = structure.bodies[first];
    if (!body.links || body.robot != structure.bodies[second].robot) continue;
    Element& element = by_robot.try_emplace(body.robot, Element{body.links.get(), ""}).first->second;
    element.tags += std::string("  <") + (entry.allowed ? "disable" : "enable") + "_collisions link1=\"" +
                    xmlEscaped(localPart(entry.first)) + "\" link2=\"" + xmlEscaped(localPart(entry.second)) +
                    "\" reason=\"" + xmlEscaped(entry.reason) + "\"/>\n";
  }
  std::string text;
  for (const auto& robot : by_robot) {
    const auto& [links, tags] = robot.second;
    text += "<robot name=\"" + xmlEscaped(links->modelName()) + "\">\n" + tags + "</robot>\n";
  }
  return text;
}

}  // namespace hgrid
