// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#include "node/audit/expected_filter.h"

#include <algorithm>
#include <string>
#include <vector>

namespace hgrid {
namespace {

/// Whether a glob matches the whole name. Visits each character of the glob once. After a visit, `matched[n]` says
/// whether the visited part of the glob matches the first n characters of the name. The node uses another algorithm,
/// which is matches() in bodies/name.h.
bool fits(const std::string& glob, const std::string& name) {
  std::vector<bool> matched(name.size() + 1, false);
  matched[0] = true;
  for (const char c : glob) {
    if (c == '*') {
      for (std::size_t n = 1; n <= name.size(); ++n) matched[n] = matched[n] || matched[n - 1];
      continue;
    }
    for (std::size_t n = name.size(); n > 0; --n) matched[n] = matched[n - 1] && c == name[n - 1];
    matched[0] = false;
  }
  return matched.back();
}

template <class Entry>
bool names(const Entry& entry, const std::string& a, const std::string& b) {
  return (fits(entry.first, a) && fits(entry.second, b)) || (fits(entry.first, b) && fits(entry.second, a));
}

bool hasWildcard(const PairRule& rule) { return (rule.first + rule.second).find('*') != std::string::npos; }

}  // namespace

/// Whether pairs of this kind exist at all (~pair_kinds).
bool ExpectedFilter::exists(std::uint32_t first, std::uint32_t second) const {
  const Body &a = audited_.bodies[first], &b = audited_.bodies[second];
  const PairKinds& kinds = audited_.pair_kinds;
  if (a.mobility == Mobility::fixed && b.mobility == Mobility::fixed) return false;
  const int links = (a.kind == BodyKind::link) + (b.kind == BodyKind::link);
  if (links == 2) return a.robot == b.robot ? kinds.self : kinds.robot_robot;
  if (links == 1) {
    const Body& other = a.kind == BodyKind::link ? b : a;
    const bool has_cells = other.kind == BodyKind::map || other.kind == BodyKind::cloud;
    return has_cells ? kinds.robot_map : kinds.robot_obstacle;
  }
  const auto moves = [](const Body& body) {
    return (body.kind == BodyKind::obstacle || body.kind == BodyKind::track) && body.mobility == Mobility::moving;
  };
  return kinds.moving_obstacle && (moves(a) || moves(b));
}

bool ExpectedFilter::reports(std::uint32_t first, std::uint32_t second) const {
  if (!exists(first, second)) return false;
  const std::string &a = audited_.bodies[first].name, &b = audited_.bodies[second].name;
  for (const bool wildcard : {false, true}) {  // rules without a wildcard take precedence
    for (auto rule = audited_.rules.rbegin(); rule != audited_.rules.rend(); ++rule) {
      if (hasWildcard(*rule) == wildcard && names(*rule, a, b)) return !rule->allowed;
    }
  }
  if (audited_.bodies[first].group == audited_.bodies[second].group && !audited_.bodies[first].group.empty())
    return false;
  const std::pair<std::uint32_t, std::uint32_t> pair(std::min(first, second), std::max(first, second));
  return !std::binary_search(audited_.switched_off.begin(), audited_.switched_off.end(), pair);
}

double ExpectedFilter::growthOf(std::uint32_t body) const {
  const BodyPose& pose = audited_.poses[body];
  if (pose.state == Freshness::unplaced) return 0.0;
  const bool old = pose.state >= Freshness::stale || pose.age > audited_.growth_after;
  const double grows_for = std::max(old ? pose.age : 0.0, pose.period > audited_.growth_after ? pose.period : 0.0);
  if (!(grows_for > 0.0)) return 0.0;
  return std::min(audited_.growth_cap, audited_.bodies[body].max_speed * grows_for);
}

double ExpectedFilter::marginOf(std::uint32_t first, std::uint32_t second) const {
  const Body &a = audited_.bodies[first], &b = audited_.bodies[second];
  const bool together = a.kind == BodyKind::link && a.robot == b.robot;  // their growth is 0 or more, so 0 is the least
  const double growth = together ? 0.0 : growthOf(first) + growthOf(second);
  for (auto entry = audited_.pair_margins.rbegin(); entry != audited_.pair_margins.rend(); ++entry) {
    if (names(*entry, a.name, b.name)) return entry->margin + growth;
  }
  return std::max({audited_.margin, a.margin, b.margin}) + growth;
}

double ExpectedFilter::shareOf(std::uint32_t body) const {
  const std::string& name = audited_.bodies[body].name;
  double own = std::max(audited_.margin, audited_.bodies[body].margin);
  for (const PairMargin& entry : audited_.pair_margins) {
    if (fits(entry.first, name) || fits(entry.second, name)) own = std::max(own, entry.margin);
  }
  return own - 0.5 * audited_.margin + growthOf(body);
}

double ExpectedFilter::mostOf(std::uint32_t body) const {
  double most = std::max(audited_.margin, audited_.bodies[body].margin);
  for (const PairMargin& entry : audited_.pair_margins) most = std::max(most, entry.margin);
  return most + growthOf(body);
}

}  // namespace hgrid
