// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#include "node/world/obstacle_draft.h"

#include <algorithm>
#include <utility>

#include "hgrid_proximity/refusal.h"
#include "node/sources/source_id.h"

namespace hgrid {
namespace {

/// Returns whether the body and the mover of an obstacle stay the same. Its lifetime and its owner may change.
bool isOnlyRenewed(const PlacedObstacle& before, const PlacedObstacle& after) {
  return !before.lost && before.restored == after.restored && before.carrier_speed == after.carrier_speed &&
         !before.attachment == !after.attachment && isAtSamePlace(before, after) &&
         (before.what == after.what || isSame(*before.what, *after.what));
}

/// Returns the rules for what may touch the attached obstacles after the edits. @throws Refusal limit
std::vector<PairRule> touchRulesAfter(const ObstacleEdits& edits, const PlacedObstacles& present,
                                      const Params& params) {
  const auto visit = [&](const auto& act) {
    for (const auto& [name, obstacle] : present) {
      if (obstacle.attachment && edits.removed.count(name) == 0 && edits.set.count(name) == 0) act(name, obstacle);
    }
    for (const auto& [name, obstacle] : edits.set) {
      if (obstacle.attachment) act(name, obstacle);
    }
  };
  // Links that never move relative to an obstacle do not count, so a new model of a robot cannot exceed the limit.
  std::size_t count = 0;
  visit([&](const std::string&, const PlacedObstacle& obstacle) {
    count += obstacle.attachment->touch.size() + obstacle.attachment->touch_links.size() + 1;
  });
  const auto most = static_cast<std::size_t>(params.max_rules);
  if (count > most) {
    throw Refusal(Code::limit, "the attached obstacles would need " + std::to_string(count) +
                                   " rules for their links and the globs in touch; at most " + std::to_string(most) +
                                   " are allowed (~limits/max_rules)");
  }
  std::vector<PairRule> rules;
  visit([&](const std::string& name, const PlacedObstacle& obstacle) {
    for (const std::string& other : obstacle.touch) {
      PairRule rule{name, other, name + " is attached to " + obstacle.attachment->link};
      rule.origin = Origin::attached;
      rules.push_back(std::move(rule));
    }
  });
  return rules;
}

}  // namespace

ObstacleDraft draftOf(ObstacleEdits edits, const PlacedObstacles& present, bool some_attached, const Params& params,
                      const std::string& world_frame) {
  ObstacleDraft draft;
  for (const std::string& name : edits.removed) {
    if (present.count(name) == 0) continue;
    draft.leaving.insert(name);
    draft.outdated.push_back(name);
  }
  draft.coming.reserve(edits.set.size());
  for (const auto& [name, next] : edits.set) {
    draft.first_end = std::min(draft.first_end, next.ends);
    const auto old = present.find(name);
    if (old != present.end()) draft.outdated.push_back(name);
    if (old != present.end() && isOnlyRenewed(old->second, next)) continue;
    if (old != present.end()) draft.leaving.insert(name);
    draft.coming.add(SourceId::ofObstacle(name), bodyOf(next, world_frame));
  }
  const bool some_attach = std::any_of(edits.set.begin(), edits.set.end(),
                                       [](const auto& edit) { return edit.second.attachment != nullptr; });
  if (some_attached || some_attach) draft.touch = touchRulesAfter(edits, present, params);
  draft.edits = std::move(edits);
  return draft;
}

void beginLifetimes(ObstacleDraft& draft, Time now) noexcept {
  draft.first_end = Time::max();
  for (auto& edit : draft.edits.set) {
    edit.second.ends = endOf(*edit.second.what, now);
    draft.first_end = std::min(draft.first_end, edit.second.ends);
  }
}

}  // namespace hgrid
