// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#include "node/world/obstacle_bodies.h"

#include <algorithm>
#include <optional>
#include <set>
#include <utility>
#include <vector>

#include "hgrid_proximity/bodies/name.h"
#include "node/sources/body_params.h"
#include "node/sources/configured_obstacle.h"

namespace hgrid {
namespace {

/// Completes what was stored of an obstacle, for this run of the node.
void complete(PlacedObstacle& obstacle, const Params& params, const std::string& world_frame, Time now) {
  auto what = std::make_shared<RequestedObstacle>(*obstacle.what);
  applySpeedBound(params, what->body);
  obstacle.ends = endOf(*what, now);
  // If the world frame is another one now, a repeated request is for another place than before.
  const std::string asked_frame = obstacle.asked.at ? std::string() : obstacle.asked.frame;
  if (followedFrame(asked_frame, what->body.name, world_frame) != obstacle.frame)
    obstacle.asked = {obstacle.frame, obstacle.frame_from_body, std::nullopt};
  obstacle.what = std::move(what);
}

}  // namespace

ObstacleBodies::ObstacleBodies(const Params& params, std::shared_ptr<NarrowPhase> narrow_phase, StoredWorld stored,
                               Ledger& ledger)
    : params_(params), narrow_phase_(std::move(narrow_phase)), ledger_(ledger), removed_(std::move(stored.removed)) {
  for (PlacedObstacle& obstacle : stored.obstacles) {
    const std::string name = obstacle.what->body.name;
    stored_.insert_or_assign(name, std::move(obstacle));
  }
}

void ObstacleBodies::startAgain() noexcept {
  done_ = 0;
  present_.clear();
  stored_.clear();
  removed_.clear();
  unsaved_.all_removed = true;
  unsaved_.names.clear();
  touch_.rules.clear();
  ++touch_.revision;
  first_end_ = Time::max();
}

void ObstacleBodies::addAll(const std::string& world_frame, Time now, Movers& movers, MissingSources& missing) {
  while (done_ < params_.obstacles.size()) {
    const ObstacleParams& configured = params_.obstacles[done_];
    const std::string& local = configured.body.name;
    try {
      // What an earlier run made of an obstacle takes precedence over the parameters.
      const bool was_changed = stored_.count(local) != 0 || removed_.count(local) != 0;
      if (!was_changed) addConfigured(configured, world_frame, now, movers);
      ++done_;
    } catch (const Refusal& refusal) {
      missing.set(SourceId::ofObstacle(local), std::string(name(refusal.code())) + " " + refusal.what());
      ++done_;
      ledger_.refuse("obstacles.refused", refusal);
    }
  }
  if (!stored_.empty()) addStored(world_frame, now, movers, missing);
}

void ObstacleBodies::addConfigured(const ObstacleParams& configured, const std::string& world_frame, Time now,
                                   Movers& movers) {
  PlacedObstacles added;
  PlacedObstacle& obstacle = added[configured.body.name];
  obstacle.what = requestedOf(configured, params_, *narrow_phase_);
  obstacle.owner = obstacle.what->owner;
  obstacle.asked = obstacle.what->place;
  obstacle.frame = followedFrame(obstacle.asked.frame, configured.body.name, world_frame);
  obstacle.frame_from_body = obstacle.asked.frame_from_body;
  obstacle.ends = endOf(*obstacle.what, now);
  obstacle.attachment = attachmentOf(configured);
  for (const auto& [name, other] : present_) {
    if (configured.body.group.empty() || other.what->body.group != configured.body.group) continue;
    checkMoveTogether(obstacle, other);  // the others of the group move together with this one
    break;
  }
  if (obstacle.attachment) {  // followRobots() finds the right place when the robot is there
    obstacle.frame = obstacle.attachment->link;
    obstacle.frame_from_body = *obstacle.attachment->link_from_body;
    obstacle.touch = obstacle.attachment->touch;
    ObstacleEdits edits;
    edits.set = std::move(added);
    carryOut(std::move(edits), world_frame, movers);
    robots_revision_ = kNoRevision;
    return;
  }
  const Time first_end = std::min(first_end_, obstacle.ends);
  movers.add(SourceId::ofObstacle(configured.body.name), bodyOf(obstacle, world_frame));
  present_.merge(added);  // does not throw
  first_end_ = first_end;
}

/// Adds the stored obstacles: all together, which is fast, or one by one if one of them is refused.
void ObstacleBodies::addStored(const std::string& world_frame, Time now, Movers& movers, MissingSources& missing) {
  std::set<std::string> lost;
  for (auto& [name, obstacle] : stored_) {
    complete(obstacle, params_, world_frame, now);
    if (obstacle.lost) lost.insert(name);
  }
  try {
    ObstacleEdits edits;
    edits.set = stored_;
    carryOut(std::move(edits), world_frame, movers);
    movers.beginLost(lost);
    stored_.clear();
    return;
  } catch (const Refusal&) {  // the loop below finds out which
  }
  while (!stored_.empty()) {
    const auto& [name, obstacle] = *stored_.begin();
    try {
      ObstacleEdits edits;
      edits.set.emplace(name, obstacle);
      carryOut(std::move(edits), world_frame, movers);
      movers.beginLost(lost);  // those that were not added yet are not there, so nothing happens to them
    } catch (const Refusal& refusal) {
      missing.set(SourceId::ofObstacle(name), std::string(hgrid::name(refusal.code())) + " the stored '" +
                                                  printable(name) + "' was not restored: " + refusal.what());
      ledger_.refuse("obstacles.refused", refusal);
    }
    stored_.erase(stored_.begin());
  }
}

void ObstacleBodies::forgetUnsaved() noexcept {
  unsaved_.all_removed = false;
  unsaved_.names.clear();
}

/// Returns the rules for what may touch the attached obstacles after the edits. @throws Refusal limit
std::vector<PairRule> ObstacleBodies::touchRulesAfter(const ObstacleEdits& edits) const {
  const auto visit = [&](const auto& act) {
    for (const auto& [name, obstacle] : present_) {
      if (edits.removed.count(name) == 0 && edits.set.count(name) == 0) act(name, obstacle);
    }
    for (const auto& [name, obstacle] : edits.set) act(name, obstacle);
  };
  // Without attachments, before and after the edits, there are no rules, and the loops below are not needed.
  const bool attaches = std::any_of(edits.set.begin(), edits.set.end(),
                                    [](const auto& edit) { return edit.second.attachment != nullptr; });
  if (!attaches && touch_.rules.empty()) return {};
  // Links that never move relative to an obstacle do not count, so a new model of a robot cannot exceed the limit.
  std::size_t count = 0;
  visit([&](const std::string&, const PlacedObstacle& obstacle) {
    if (!obstacle.attachment) return;
    count += obstacle.attachment->touch.size() + obstacle.attachment->touch_links.size() + 1;
  });
  const auto most = static_cast<std::size_t>(params_.max_rules);
  if (count > most) {
    throw Refusal(Code::limit, "the attached obstacles would need " + std::to_string(count) +
                                   " rules for their links and the globs in touch; at most " + std::to_string(most) +
                                   " are allowed (~max_rules)");
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

void ObstacleBodies::apply(const ObstacleChanges& changes, const Surroundings& around, Movers& movers) {
  ObstacleEdits edits = editsOf(changes, present_, around);
  std::set<std::string> unsaved = unsavedAfter(edits);
  carryOut(std::move(edits), around.world_frame, movers);
  unsaved_.names.merge(unsaved);  // does not throw
}

void ObstacleBodies::followRobots(const RobotModels& robots, const std::string& world_frame, Movers& movers) {
  if (robots_revision_ == robots.revision()) return;
  ObstacleEdits edits;
  for (const auto& [name, obstacle] : present_) {
    if (!obstacle.attachment || obstacle.lost) continue;
    follow(edits.set.emplace(name, obstacle).first->second, robots, params_);
  }
  carryOut(std::move(edits), world_frame, movers);
  robots_revision_ = robots.revision();
}

void ObstacleBodies::expire(Time now, Movers& movers) {
  if (now < first_end_) return;
  ObstacleEdits edits;
  std::set<std::string> lost;
  Time first_end = Time::max();
  for (const auto& [name, obstacle] : present_) {
    if (obstacle.lost) continue;
    if (obstacle.ends > now) {
      first_end = std::min(first_end, obstacle.ends);
    } else {
      (obstacle.what->lost_at_end ? lost : edits.removed).insert(name);
    }
  }
  std::set<std::string> unsaved = unsavedAfter(edits);
  if (!params_.state_folder.empty()) unsaved.insert(lost.begin(), lost.end());
  carryOut(std::move(edits), "", movers);
  // The code below does not throw.
  unsaved_.names.merge(unsaved);
  movers.giveUp(lost);
  for (const std::string& name : lost) present_.find(name)->second.lost = true;
  first_end_ = first_end;
}

void ObstacleBodies::restamp(Time now) noexcept {
  for (auto& [name, obstacle] : present_) {
    if (!obstacle.lost) obstacle.ends = endOf(*obstacle.what, now);
  }
  first_end_ = now;  // the next expire() finds the right time
}

/// Changes obstacles in this object and in the movers. If only the pose of a fixed obstacle changes, the scene keeps
/// the body and its pairs.
void ObstacleBodies::carryOut(ObstacleEdits edits, const std::string& world_frame, Movers& movers) {
  std::set<std::string> leaving;
  std::vector<const PlacedObstacle*> entering;
  entering.reserve(edits.set.size());
  std::vector<PlacedObstacles::iterator> outdated;  // those that are removed from present_, or replaced
  Time first_end = first_end_;
  for (const std::string& name : edits.removed) {
    const auto old = present_.find(name);
    if (old == present_.end()) continue;
    leaving.insert(name);
    outdated.push_back(old);
  }
  for (const auto& [name, next] : edits.set) {
    first_end = std::min(first_end, next.ends);
    const auto old = present_.find(name);
    if (old != present_.end()) {
      outdated.push_back(old);
      const bool renewed = !old->second.lost && old->second.restored == next.restored &&
                           old->second.carrier_speed == next.carrier_speed &&
                           !old->second.attachment == !next.attachment && isAtSamePlace(old->second, next) &&
                           (old->second.what == next.what || isSame(*old->second.what, *next.what));
      if (renewed) continue;
      leaving.insert(name);
    }
    entering.push_back(&next);
  }
  std::vector<PairRule> touch = touchRulesAfter(edits);
  if (!leaving.empty() || !entering.empty()) {
    Movers::Change change = movers.changeWithout(
        [&](const SourceId& source) { return source.kind == SourceKind::obstacle && leaving.count(source.name) != 0; });
    change.reserve(entering.size());
    for (const PlacedObstacle* obstacle : entering) {
      Body body = bodyOf(*obstacle, world_frame);
      const std::string frame = body.frame;
      const SourceId source = SourceId::ofObstacle(body.name);
      const Pose frame_from_body = body.frame_from_body;
      change.add(frame, source, std::move(body), frame_from_body);
    }
    movers.exchange(std::move(change));
  }
  // The code below does not allocate, so it cannot fail.
  for (const auto& old : outdated) present_.erase(old);
  present_.merge(edits.set);
  if (!touch.empty() || !touch_.rules.empty()) ++touch_.revision;
  touch_.rules.swap(touch);
  first_end_ = first_end;
}

/// Returns the names of the obstacles that the edits change, if changes are stored.
std::set<std::string> ObstacleBodies::unsavedAfter(const ObstacleEdits& edits) const {
  std::set<std::string> names;
  if (params_.state_folder.empty()) return names;
  names = edits.removed;
  for (const auto& edit : edits.set) names.insert(edit.first);
  return names;
}

}  // namespace hgrid
