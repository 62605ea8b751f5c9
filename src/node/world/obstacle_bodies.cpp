// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#include "node/world/obstacle_bodies.h"

#include <algorithm>
#include <functional>
#include <optional>
#include <set>
#include <utility>
#include <vector>

#include "hgrid_proximity/bodies/name.h"
#include "node/params/body_params.h"
#include "node/sources/configured_obstacle.h"
#include "node/world/rules_in_force.h"

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

void ObstacleBodies::startAgain(SharedObstacles::Spare spare) noexcept {
  done_ = 0;
  present_.clear(std::move(spare));
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
  for (const auto& [name, other] : present_.all()) {
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
  const SharedObstacles::Access access(present_);
  const Time first_end = std::min(first_end_, obstacle.ends);
  movers.add(SourceId::ofObstacle(configured.body.name), bodyOf(obstacle, world_frame));
  access.all().merge(added);  // does not throw
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

void ObstacleBodies::apply(const ObstacleChanges& changes, const Surroundings& around, Movers& movers,
                           PreparedObstacles* prepared) {
  const bool is_up_to_date = prepared != nullptr && prepared->revision == present_.revision() &&
                             prepared->robots.get() == &around.robots && prepared->world_frame == around.world_frame;
  ObstacleDraft made_now;
  if (!is_up_to_date) {
    made_now = draftOf(editsOf(changes, present_.all(), around), present_.all(), !touch_.rules.empty(), params_,
                       around.world_frame);
  }
  ObstacleDraft& draft = is_up_to_date ? prepared->draft : made_now;
  if (is_up_to_date) beginLifetimes(draft, around.now);
  std::set<std::string> unsaved = unsavedAfter(draft.edits);
  carryOut(draft, movers);
  unsaved_.names.merge(unsaved);  // does not throw
}

std::shared_ptr<PreparedObstacles> ObstacleBodies::prepare(const ObstacleChanges& changes, const Tick& newest, Time now,
                                                           const TransformLookup& lookup, const Scene& scene,
                                                           const std::vector<PairRule>* rules) const {
  if (!newest.snapshot) return nullptr;
  auto prepared = std::make_shared<PreparedObstacles>();
  prepared->robots = newest.robots;
  prepared->world_frame = newest.world_frame;
  SharedObstacles::View view = present_.view();
  prepared->revision = view.revision;
  const Surroundings around{params_, newest.world_frame, lookup, *newest.robots, now};
  try {
    ObstacleDraft& draft = prepared->draft;
    draft = draftOf(editsOf(changes, *view.obstacles, around), *view.obstacles, true, params_, newest.world_frame);
    view.obstacles.reset();
    const std::vector<PairRule>& present = newest.snapshot->structure().filter.rules();
    std::optional<std::vector<PairRule>> next;
    if (rules != nullptr || !hasDerived(present, Origin::attached, draft.touch)) {
      next = withTouchRules(rules == nullptr ? present : *rules, draft.touch);
    }
    if (draft.leaving.empty() && draft.coming.empty() && !next) return prepared;  // the structure stays
    draft.coming.prepare(scene, *newest.snapshot, {draft.leaving.begin(), draft.leaving.end()}, next);
  } catch (const Refusal&) {
    return nullptr;  // apply() finds out whether the changes must be refused
  }
  return prepared;
}

void ObstacleBodies::followRobots(const RobotModels& robots, const std::string& world_frame, Movers& movers) {
  if (robots_revision_ == robots.revision()) return;
  ObstacleEdits edits;
  for (const auto& [name, obstacle] : present_.all()) {
    if (obstacle.lost) continue;
    if (obstacle.attachment) {
      follow(edits.set.emplace(name, obstacle).first->second, robots.all(), params_);
      continue;
    }
    const double speed = carrierSpeedOf(obstacle, robots.all(), world_frame, params_);
    if (speed == 0.0 || speed == obstacle.carrier_speed) continue;  // 0: no link; the frame may move on without it
    edits.set.emplace(name, obstacle).first->second.carrier_speed = speed;
  }
  if (!edits.set.empty()) carryOut(std::move(edits), world_frame, movers);
  robots_revision_ = robots.revision();
}

void ObstacleBodies::expire(Time now, Movers& movers) {
  if (now < first_end_) return;
  ObstacleEdits edits;
  std::set<std::string> lost;
  Time first_end = Time::max();
  for (const auto& [name, obstacle] : present_.all()) {
    if (obstacle.lost) continue;
    if (obstacle.ends > now) {
      first_end = std::min(first_end, obstacle.ends);
    } else {
      (obstacle.what->lost_at_end ? lost : edits.removed).insert(name);
    }
  }
  std::set<std::string> unsaved = unsavedAfter(edits);
  if (!params_.state_folder.empty()) unsaved.insert(lost.begin(), lost.end());
  ObstacleDraft draft = draftOf(std::move(edits), present_.all(), !touch_.rules.empty(), params_, "");
  carryOut(draft, movers, lost);
  // The code below does not throw.
  unsaved_.names.merge(unsaved);
  first_end_ = first_end;
}

void ObstacleBodies::restamp(Time now) {
  const SharedObstacles::Access access(present_);
  for (auto& [name, obstacle] : access.all()) {
    if (!obstacle.lost) obstacle.ends = endOf(*obstacle.what, now);
  }
  first_end_ = now;  // the next expire() finds the right time
}

void ObstacleBodies::carryOut(ObstacleEdits edits, const std::string& world_frame, Movers& movers) {
  ObstacleDraft draft = draftOf(std::move(edits), present_.all(), !touch_.rules.empty(), params_, world_frame);
  carryOut(draft, movers);
}

/// Changes obstacles in this object and in the movers. @param lost  full names of obstacles that become LOST
void ObstacleBodies::carryOut(ObstacleDraft& draft, Movers& movers, const std::set<std::string>& lost) {
  const SharedObstacles::Access access(present_);
  if (!draft.leaving.empty() || !draft.coming.empty()) {
    std::function<bool(const SourceId&)> leaves;
    if (!draft.leaving.empty()) {
      leaves = [&](const SourceId& source) {
        return source.kind == SourceKind::obstacle && draft.leaving.count(source.name) != 0;
      };
    }
    movers.exchange(leaves, std::move(draft.coming));
  }
  // The code below does not allocate, so it cannot fail.
  PlacedObstacles& all = access.all();
  for (const std::string& name : draft.outdated) draft.retired.insert(all.extract(name));
  all.merge(draft.edits.set);
  movers.giveUp(lost);
  for (const std::string& name : lost) all.find(name)->second.lost = true;
  if (!draft.touch.empty() || !touch_.rules.empty()) ++touch_.revision;
  touch_.rules.swap(draft.touch);
  first_end_ = std::min(first_end_, draft.first_end);
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
