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

/// Collects a warning for each pattern that matches no body.
class Check {
 public:
  Check(const Params& params, const std::vector<std::string>& bodies) : params_(params), bodies_(bodies) {}

  void operator()(const std::string& parameter, const std::string& pattern) {
    if (mayMatchLater(pattern) || !matchesNone(pattern, bodies_)) return;
    warnings_.push_back(parameter + ": '" + printable(pattern) + "' matches no body");
  }
  void operator()(const std::string& parameter, const std::vector<PatternValue>& values) {
    for (const PatternValue& value : values) (*this)(parameter, value.pattern);
  }
  std::vector<std::string> warnings() && { return std::move(warnings_); }

 private:
  /// Whether the pattern is meant for maps only, or can match a configured map or a track of a configured tracker.
  bool mayMatchLater(const std::string& pattern) const {
    return coversGlob("map/*", pattern) ||
           std::any_of(params_.maps.begin(), params_.maps.end(),
                       [&](const MapParams& map) { return matches(pattern, joined("map", map.name)); }) ||
           std::any_of(params_.trackers.begin(), params_.trackers.end(), [&](const TrackerParams& tracker) {
             return canMatchTogether(pattern, joined("track", tracker.name + "/*"));
           });
  }

  const Params& params_;
  const std::vector<std::string>& bodies_;
  std::vector<std::string> warnings_;
};

}  // namespace

std::vector<std::string> idlePatterns(const Params& params, const std::vector<std::string>& bodies,
                                      const std::vector<std::string>& without_collision) {
  Check check(params, bodies);
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
