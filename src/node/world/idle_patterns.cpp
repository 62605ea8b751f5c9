// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#include "node/world/idle_patterns.h"

#include <algorithm>

#include "hgrid_proximity/bodies/name.h"
#include "hgrid_proximity/refusal.h"

namespace hgrid {
namespace {

bool matchesNone(const std::string& pattern, const std::vector<std::string>& names) {
  return std::none_of(names.begin(), names.end(), [&](const std::string& name) { return matches(pattern, name); });
}

/// Whether the pattern is meant for maps: every name that it can match begins with "map/".
bool isForMaps(const std::string& pattern) { return coversGlob("map/*", pattern); }

/// Collects a warning for each pattern that matches no body.
class Check {
 public:
  explicit Check(const std::vector<std::string>& bodies) : bodies_(bodies) {}

  void operator()(const std::string& parameter, const std::string& pattern) {
    if (isForMaps(pattern) || !matchesNone(pattern, bodies_)) return;
    warnings_.push_back(parameter + ": '" + printable(pattern) + "' matches no body");
  }
  void operator()(const std::string& parameter, const std::vector<PatternValue>& values) {
    for (const PatternValue& value : values) (*this)(parameter, value.pattern);
  }
  std::vector<std::string> warnings() && { return std::move(warnings_); }

 private:
  const std::vector<std::string>& bodies_;
  std::vector<std::string> warnings_;
};

}  // namespace

std::vector<std::string> idlePatterns(const Params& params, const std::vector<std::string>& bodies,
                                      const std::vector<std::string>& without_collision) {
  Check check(bodies);
  check("~margins", params.margins);
  check("~padding", params.padding);
  check("~max_speed", params.max_speed);
  check("~map/self_filter", params.map_self_filter);
  for (const Waiver& waiver : params.accept_uncovered) {
    if (matchesNone(waiver.pattern, without_collision)) check("~accept_uncovered", waiver.pattern);
  }
  for (const std::string& pattern : params.use_visual) {
    if (matchesNone(pattern, without_collision)) check("~use_visual", pattern);
  }
  for (const PairMargin& pair : params.pair_margins) {
    check("~pair_margins", pair.first);
    check("~pair_margins", pair.second);
  }
  for (const PairRule& rule : params.allowed_pairs) {
    check("~allowed_pairs", rule.first);
    check("~allowed_pairs", rule.second);
  }
  return std::move(check).warnings();
}

}  // namespace hgrid
