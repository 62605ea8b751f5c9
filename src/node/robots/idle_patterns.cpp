// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#include "node/robots/idle_patterns.h"

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
    const bool has_other = pattern.find_first_of("?[") != std::string::npos;
    warnings_.push_back(parameter + ": '" + printable(pattern) + "' matches no body" +
                        (has_other ? "; only * stands for other characters" : ""));
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

std::vector<std::string> idleMargins(const Params& params) {
  std::vector<std::string> warnings;
  for (const PatternValue& margin : params.margins) {
    if (margin.value >= params.margin) continue;
    warnings.push_back("~margins: '" + printable(margin.pattern) + "' has " + text(margin.value) +
                       " m, but ~margin is " + text(params.margin) +
                       " m for all bodies; only ~pair_margins can be smaller");
  }
  const std::vector<PairMargin>& pairs = params.pair_margins;
  for (auto entry = pairs.begin(); entry != pairs.end(); ++entry) {
    const bool is_hidden = std::any_of(entry + 1, pairs.end(), [&](const PairMargin& later) {
      return (coversGlob(later.first, entry->first) && coversGlob(later.second, entry->second)) ||
             (coversGlob(later.first, entry->second) && coversGlob(later.second, entry->first));
    });
    if (!is_hidden) continue;
    warnings.push_back("~pair_margins: '" + printable(entry->first) + "' with '" + printable(entry->second) +
                       "' has no effect, because a later entry matches the same pairs; put the general one first");
  }
  return warnings;
}

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
