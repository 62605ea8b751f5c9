// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#include "hgrid_proximity/explain/changed_pairs.h"

#include <algorithm>
#include <iterator>
#include <map>
#include <string>
#include <tuple>
#include <utility>

#include "bodies/name_index.h"

namespace hgrid {
namespace {

using Bodies = std::vector<std::uint32_t>;

/// Returns the names and globs of the rules in which two lists differ.
///
/// If two equally exact rules match a pair, the later one decides, so the order of rules matters. Therefore only two
/// parts of the lists surely make no difference: the common rules at the start, and the common rules at the end.
std::vector<std::string> changedNames(const std::vector<PairRule>& before, const std::vector<PairRule>& after) {
  const auto same = [](const PairRule& a, const PairRule& b) {
    return std::tie(a.first, a.second, a.allowed) == std::tie(b.first, b.second, b.allowed);
  };
  const auto begin = std::mismatch(before.begin(), before.end(), after.begin(), after.end(), same);
  const auto end = std::mismatch(before.rbegin(), std::make_reverse_iterator(begin.first), after.rbegin(),
                                 std::make_reverse_iterator(begin.second), same);
  std::vector<std::string> names;
  const auto note = [&](auto rule, auto last) {
    for (; rule != last; ++rule) {
      names.push_back(rule->first);
      names.push_back(rule->second);
    }
  };
  note(begin.first, end.first.base());
  note(begin.second, end.second.base());
  std::sort(names.begin(), names.end());
  names.erase(std::unique(names.begin(), names.end()), names.end());
  return names;
}

/// Returns the bodies that match at least one of the names or globs, sorted.
Bodies matching(const std::vector<std::string>& names, const BodyList& bodies) {
  const NameIndex index(bodies);
  std::vector<bool> is_in(bodies.size(), false);
  Bodies found;
  for (const std::string& name : names) {
    if (isGlob(name)) {
      index.matching(name, found);
    } else {
      found.assign(1, index.find(name));
    }
    for (const std::uint32_t body : found) {
      if (body != NameIndex::kNone) is_in[body] = true;
    }
  }
  found.clear();
  for (std::uint32_t body = 0; body < bodies.size(); ++body) {
    if (is_in[body]) found.push_back(body);
  }
  return found;
}

/// A group of bodies that both filters treat alike in pairs with bodies outside their robot. The bodies are links of
/// one robot, or none of them is a link.
struct Group {
  std::string robot;  // name of the robot; empty if the bodies are no links
  Bodies bodies;
};

std::vector<Group> groupsOf(const Bodies& chosen, const BodyList& bodies, const PairFilter& before,
                            const PairFilter& after) {
  std::map<std::pair<std::string, std::vector<std::uint64_t>>, Bodies> by_key;
  for (const std::uint32_t body : chosen) {
    std::vector<std::uint64_t> key;
    before.appendKey(body, key);
    after.appendKey(body, key);
    const bool is_link = bodies[body].kind == BodyKind::link;
    by_key[{is_link ? bodies[body].robot : std::string(), std::move(key)}].push_back(body);
  }
  std::vector<Group> groups;
  groups.reserve(by_key.size());
  for (auto& group : by_key) groups.push_back({group.first.first, std::move(group.second)});
  return groups;
}

/// Counts the changed pairs of a body of the first group and a body of the second group.
/// @param same  whether the two groups are the same
template <class IsChanged>
std::uint64_t countBetween(const Group& first, const Group& second, bool same, const IsChanged& is_changed) {
  if (!first.robot.empty() && first.robot == second.robot) {  // the matrix of the robot decides for each pair of links
    std::uint64_t count = 0;
    for (std::size_t i = 0; i < first.bodies.size(); ++i) {
      for (std::size_t j = same ? i + 1 : 0; j < second.bodies.size(); ++j) {
        if (is_changed(first.bodies[i], second.bodies[j])) ++count;
      }
    }
    return count;
  }
  const std::uint64_t size = first.bodies.size();
  const std::uint64_t pairs = same ? size * (size - 1) / 2 : size * second.bodies.size();
  return pairs > 0 && is_changed(first.bodies.front(), second.bodies.back()) ? pairs : 0;
}

}  // namespace

std::uint64_t changedPairs(const BodyList& bodies, const PairFilter& before, const PairFilter& after) {
  const std::vector<std::string> names = changedNames(before.rules(), after.rules());
  if (names.empty()) return 0;
  const std::vector<Group> groups = groupsOf(matching(names, bodies), bodies, before, after);
  const auto is_changed = [&](std::uint32_t a, std::uint32_t b) { return before.allowed(a, b) != after.allowed(a, b); };
  std::uint64_t count = 0;
  for (std::size_t i = 0; i < groups.size(); ++i) {
    for (std::size_t j = i; j < groups.size(); ++j) count += countBetween(groups[i], groups[j], i == j, is_changed);
  }
  return count;
}

}  // namespace hgrid
