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

/// Returns the end of a lifetime that begins at `now`; Time::max(): never.
Time endOf(const RequestedObstacle& obstacle, Time now) {
  if (obstacle.lifetime == std::chrono::nanoseconds(0)) return Time::max();
  return obstacle.lifetime > Time::max() - now ? Time::max() : now + obstacle.lifetime;
}

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

/// Notes that an obstacle has changed: its lifetime begins again, and it is neither lost nor only restored.
void renew(PlacedObstacle& obstacle, Time now) {
  obstacle.ends = endOf(*obstacle.what, now);
  obstacle.lost = false;
  obstacle.restored = false;
}

/// @throws Refusal conflict if two obstacles of one group would not move together
void checkMoveTogether(const PlacedObstacle& added, const PlacedObstacle& other) {
  if (moveTogether(added, other)) return;
  const std::string where = other.attachment ? "is attached to '" + printable(other.attachment->link) + "'"
                                             : "follows the frame '" + printable(other.frame) + "'";
  throw Refusal(Code::conflict, "'" + printable(added.what->body.name) + "' cannot be in the group '" +
                                    printable(added.what->body.group) + "', because '" +
                                    printable(other.what->body.name) + "' " + where +
                                    "; obstacles of one group must follow the same frame or link");
}

/// Returns whether the obstacle of a change belongs to the complete set of the request.
bool belongsToSet(const ObstacleChange& change) {
  using Kind = ObstacleChange::Kind;
  return change.kind == Kind::add || change.kind == Kind::append || (change.kind == Kind::attach && change.in_set);
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
  Obstacles added;
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
    Edits edits;
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
    Edits edits;
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
      Edits edits;
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

const PlacedObstacle* ObstacleBodies::find(const Edits& edits, const std::string& name) const {
  if (edits.removed.count(name) != 0) return nullptr;
  const auto edit = edits.set.find(name);
  if (edit != edits.set.end()) return &edit->second;
  const auto found = present_.find(name);
  return found == present_.end() ? nullptr : &found->second;
}

const PlacedObstacle& ObstacleBodies::known(const std::string& name, const Edits& edits) const {
  const PlacedObstacle* found = find(edits, name);
  if (found == nullptr)
    throw Refusal(Code::unknown_id,
                  "there is no '" + printable(name) + "'; only an existing obstacle can be changed (see ~bodies)");
  return *found;
}

/// Returns the obstacle that a change adds, or the present one if it is equal.
PlacedObstacle ObstacleBodies::added(const ObstacleChange& change, const Edits& edits,
                                     const Surroundings& around) const {
  PlacedObstacle next;
  next.what = change.added;
  next.owner = change.added->owner;
  const PlacedObstacle* old = find(edits, change.name);
  const bool is_same = old != nullptr && !old->attachment && isSame(*old->what, *next.what);
  // The transform for an old stamp may be forgotten, so a repeated request is not placed again.
  const bool is_repeated = is_same && isSame(old->asked, change.added->place);
  if (!is_repeated) put(next, change.added->place, around);
  if (old == nullptr) return next;
  if (is_repeated || (is_same && isAtSamePlace(*old, next))) {
    next = *old;
    next.owner = change.added->owner;
  } else if (!change.replace) {
    throw Refusal(Code::dup_id, "'" + printable(change.name) +
                                    "' exists already, and is different, elsewhere or attached; remove it first, "
                                    "or set replace = true");
  }
  return next;
}

/// Returns the obstacle after a change. @throws Refusal
PlacedObstacle ObstacleBodies::changed(const ObstacleChange& change, const Edits& edits,
                                       const Surroundings& around) const {
  using Kind = ObstacleChange::Kind;
  const bool is_new = change.kind == Kind::add || (change.kind == Kind::append && find(edits, change.name) == nullptr);
  PlacedObstacle next = is_new ? added(change, edits, around) : known(change.name, edits);
  if (change.kind == Kind::append && !is_new) append(next, *change.added, around);
  if (change.kind == Kind::attach) attach(next, *change.attachment, around);
  if (change.kind == Kind::detach) detach(next, around);
  if (change.kind == Kind::move) {
    if (next.attachment) {
      throw Refusal(Code::conflict, "'" + printable(change.name) + "' is attached to '" +
                                        printable(next.attachment->link) +
                                        "'; detach it before you move it, or attach it again at another attach_pose");
    }
    if (!change.shape_poses.empty()) placeShapes(next, change.shape_poses);
    put(next, change.place, around);
  }
  checkPlanes(next, around.world_frame);
  renew(next, around.now);
  return next;
}

/// Returns the rules for what may touch the attached obstacles after the edits. @throws Refusal limit
std::vector<PairRule> ObstacleBodies::touchRulesAfter(const Edits& edits) const {
  const auto visit = [&](const auto& act) {
    for (const auto& [name, obstacle] : present_) {
      if (edits.removed.count(name) == 0 && edits.set.count(name) == 0) act(name, obstacle);
    }
    for (const auto& [name, obstacle] : edits.set) act(name, obstacle);
  };
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

/// Carries out one change on the edits. @throws Refusal
void ObstacleBodies::edit(const ObstacleChange& change, const Surroundings& around, Edits& edits) const {
  using Kind = ObstacleChange::Kind;
  const auto remove = [&](const std::string& name) {
    regroup(find(edits, name), nullptr, edits);
    edits.removed.insert(name);
    edits.set.erase(name);
  };
  const PlacedObstacle* old = find(edits, change.name);
  if (change.free_only && old != nullptr && old->attachment) {
    throw Refusal(Code::conflict, "'" + printable(change.name) + "' is attached to '" +
                                      printable(old->attachment->link) + "'; detach it first");
  }
  switch (change.kind) {
    case Kind::remove:
      known(change.name, edits);
      return remove(change.name);
    case Kind::remove_all_free:
      for (const std::string& name : chosen(edits, [&](const PlacedObstacle& obstacle) {
             return !obstacle.attachment && obstacle.owner == change.owner;
           })) {
        remove(name);
      }
      return;
    case Kind::detach_all:
      for (const std::string& name : chosen(edits, [&](const PlacedObstacle& obstacle) {
             return obstacle.attachment && obstacle.attachment->owner == change.owner &&
                    (change.link.empty() || isNameOfLink(change.link, obstacle.attachment->link));
           })) {
        if (!find(edits, name)->attachment) continue;  // it was detached with another one of its group
        ObstacleChange one;
        one.kind = Kind::detach;
        one.name = name;
        edit(one, around, edits);
      }
      return;
    case Kind::add:
    case Kind::append:
    case Kind::move:
    case Kind::attach:
    case Kind::detach:
      break;
  }
  PlacedObstacle next = changed(change, edits, around);
  const bool is_placed_alone = change.kind == Kind::add || change.kind == Kind::append;
  if (!next.what->body.group.empty() && !edits.without_groups) {
    if (is_placed_alone) {
      checkGroup(next, edits);
    } else {
      carryGroup(*old, next, around, edits);
    }
  }
  regroup(find(edits, change.name), &next, edits);
  edits.set.insert_or_assign(change.name, std::move(next));
  edits.removed.erase(change.name);
}

/// Returns the names of the obstacles in the group of an obstacle, after the edits.
const std::set<std::string>& ObstacleBodies::groupOf(const PlacedObstacle& obstacle, Edits& edits) const {
  if (!edits.groups) {
    edits.groups.emplace();
    for (const std::string& name :
         chosen(edits, [](const PlacedObstacle& one) { return !one.what->body.group.empty(); })) {
      (*edits.groups)[find(edits, name)->what->body.group].insert(name);
    }
  }
  return (*edits.groups)[obstacle.what->body.group];
}

/// Keeps Edits::groups up to date when an obstacle is about to change. Null: there is no such obstacle.
void ObstacleBodies::regroup(const PlacedObstacle* before, const PlacedObstacle* after, Edits& edits) {
  if (!edits.groups) return;
  if (before != nullptr) (*edits.groups)[before->what->body.group].erase(before->what->body.name);
  if (after != nullptr) (*edits.groups)[after->what->body.group].insert(after->what->body.name);
}

/// @throws Refusal conflict if the obstacle would not move together with the others of its group
void ObstacleBodies::checkGroup(const PlacedObstacle& added, Edits& edits) const {
  for (const std::string& name : groupOf(added, edits)) {
    if (name == added.what->body.name) continue;
    return checkMoveTogether(added, *find(edits, name));  // the others move together with this one
  }
}

/// Lets the other obstacles of a group move with one of them.
/// @throws Refusal limit if the changes of a request move too many obstacles in this way, or as carry()
void ObstacleBodies::carryGroup(const PlacedObstacle& before, const PlacedObstacle& after, const Surroundings& around,
                                Edits& edits) const {
  const std::size_t most = 4 * static_cast<std::size_t>(params_.max_bodies);
  for (const std::string& name : groupOf(after, edits)) {
    if (name == after.what->body.name) continue;
    if (++edits.carried > most) {
      throw Refusal(Code::limit, "the changes would move more than " + std::to_string(most) +
                                     " obstacles with their groups (4 * ~max_bodies); move each group only once");
    }
    PlacedObstacle next = *find(edits, name);
    carry(next, before, after, around);
    checkPlanes(next, around.world_frame);
    renew(next, around.now);
    edits.set.insert_or_assign(name, std::move(next));
  }
}

/// Returns the names of the obstacles, after the edits, for which `is_chosen` returns true.
std::vector<std::string> ObstacleBodies::chosen(const Edits& edits,
                                                const std::function<bool(const PlacedObstacle&)>& is_chosen) const {
  std::vector<std::string> names;
  for (const auto& [name, obstacle] : present_) {
    if (edits.removed.count(name) == 0 && edits.set.count(name) == 0 && is_chosen(obstacle)) names.push_back(name);
  }
  for (const auto& [name, obstacle] : edits.set) {
    if (is_chosen(obstacle)) names.push_back(name);
  }
  return names;
}

void ObstacleBodies::apply(const ObstacleChanges& changes, const Surroundings& around, Movers& movers) {
  Edits edits;
  edits.without_groups = changes.without_groups;
  std::set<std::string> complete_set;
  for (std::size_t i = 0; i < changes.changes.size(); ++i) {
    const ObstacleChange& change = changes.changes[i];
    try {
      edit(change, around, edits);
      if (belongsToSet(change)) complete_set.insert(change.name);
    } catch (const Refusal& refusal) {
      throw ChangeRefusal(i, refusal);
    }
  }
  if (changes.complete_set_of) {
    for (const auto& [name, obstacle] : present_) {
      if (obstacle.owner != *changes.complete_set_of || complete_set.count(name) != 0) continue;
      const PlacedObstacle* next = find(edits, name);
      if (changes.spare_attached && next != nullptr && next->attachment) continue;
      edits.removed.insert(name);
      edits.set.erase(name);
    }
  }
  if (edits.without_groups) {
    for (const auto& [name, obstacle] : edits.set) {
      if (!obstacle.what->body.group.empty()) checkGroup(obstacle, edits);
    }
  }
  std::set<std::string> unsaved = unsavedAfter(edits);
  carryOut(std::move(edits), around.world_frame, movers);
  unsaved_.names.merge(unsaved);  // does not throw
}

void ObstacleBodies::followRobots(const RobotModels& robots, const std::string& world_frame, Movers& movers) {
  if (robots_revision_ == robots.revision()) return;
  Edits edits;
  for (const auto& [name, obstacle] : present_) {
    if (!obstacle.attachment || obstacle.lost) continue;
    follow(edits.set.emplace(name, obstacle).first->second, robots, params_);
  }
  carryOut(std::move(edits), world_frame, movers);
  robots_revision_ = robots.revision();
}

void ObstacleBodies::expire(Time now, Movers& movers) {
  if (now < first_end_) return;
  Edits edits;
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
void ObstacleBodies::carryOut(Edits edits, const std::string& world_frame, Movers& movers) {
  std::set<std::string> leaving;
  std::vector<Body> entering;
  Time first_end = first_end_;
  for (const std::string& name : edits.removed) {
    if (present_.count(name) != 0) leaving.insert(name);
  }
  for (const auto& [name, next] : edits.set) {
    first_end = std::min(first_end, next.ends);
    const auto old = present_.find(name);
    if (old != present_.end()) {
      const bool renewed = !old->second.lost && old->second.restored == next.restored &&
                           old->second.carrier_speed == next.carrier_speed &&
                           !old->second.attachment == !next.attachment && isAtSamePlace(old->second, next) &&
                           (old->second.what == next.what || isSame(*old->second.what, *next.what));
      if (renewed) continue;
      leaving.insert(name);
    }
    entering.push_back(bodyOf(next, world_frame));
  }
  std::vector<PairRule> touch = touchRulesAfter(edits);
  if (!leaving.empty() || !entering.empty()) {
    Movers::Change change = movers.changeWithout(
        [&](const SourceId& source) { return source.kind == SourceKind::obstacle && leaving.count(source.name) != 0; });
    for (const Body& body : entering) {
      change.add(body.frame, SourceId::ofObstacle(body.name), body, body.frame_from_body);
    }
    movers.exchange(std::move(change));
  }
  // The code below does not allocate, so it cannot fail.
  for (const std::string& name : edits.removed) present_.erase(name);
  for (const auto& edit : edits.set) present_.erase(edit.first);
  present_.merge(edits.set);
  if (!touch.empty() || !touch_.rules.empty()) ++touch_.revision;
  touch_.rules.swap(touch);
  first_end_ = first_end;
}

/// Returns the names of the obstacles that the edits change, if changes are stored.
std::set<std::string> ObstacleBodies::unsavedAfter(const Edits& edits) const {
  std::set<std::string> names;
  if (params_.state_folder.empty()) return names;
  names = edits.removed;
  for (const auto& edit : edits.set) names.insert(edit.first);
  return names;
}

}  // namespace hgrid
