// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#include "node/services/scene_file_services.h"

#include <ros/time.h>

#include <algorithm>
#include <cstdint>
#include <limits>
#include <memory>
#include <set>
#include <string>
#include <utility>

#include "hgrid_proximity/bodies/name.h"
#include "hgrid_proximity/pairs/rule_book.h"
#include "node/sources/configured_obstacle.h"
#include "node/state/scene_file.h"
#include "node/tick/match_names.h"
#include "node/time/ros_time.h"
#include "node/world/world.h"

namespace hgrid {
namespace {

/// Checks that each name or glob is that of a body of the world or of an obstacle of the scene. @throws Refusal
void checkNames(const std::vector<PairRule>& rules, const std::set<std::string>& obstacles, const BodyList& bodies) {
  for (const PairRule& rule : rules) {
    for (const std::string& glob : {rule.first, rule.second}) {
      const auto is_meant = [&](const std::string& name) { return matches(glob, name); };
      if (std::none_of(obstacles.begin(), obstacles.end(), is_meant)) checkKnown({PairRule{glob, glob, ""}}, bodies);
    }
  }
}

/// Returns a time as a stamp. A stamp ends in the year 2106, so a later time becomes its last second.
ros::Time rosTimeOf(const timespec& time) {
  ros::Time stamp;
  stamp.sec =
      static_cast<std::uint32_t>(std::clamp<std::int64_t>(time.tv_sec, 0, std::numeric_limits<std::uint32_t>::max()));
  stamp.nsec = static_cast<std::uint32_t>(time.tv_nsec);
  return stamp;
}

bool isService(const PairRule& rule) { return rule.origin == Origin::service; }

/// Returns the rules that are in force after the scene was loaded.
std::vector<PairRule> rulesAfter(std::vector<PairRule> present, const std::vector<PairRule>& loaded, bool replace,
                                 const std::string& caller, const Params& params) {
  if (replace) present.erase(std::remove_if(present.begin(), present.end(), isService), present.end());
  RuleBook book(std::move(present), static_cast<std::size_t>(params.max_rules));
  std::vector<PairRule> added = loaded;
  for (PairRule& rule : added) {
    rule.origin = Origin::service;
    rule.set_by = caller;
    rule.since = fromRos(ros::Time::now());
  }
  book.add(added);
  return book.rules();
}

}  // namespace

SceneFileServices::SceneFileServices(ServiceEnvelope& envelope, const Params& params,
                                     std::shared_ptr<NarrowPhase> narrow_phase, PrepareObstacles prepare,
                                     ChangeWorld change_world, WaitUntilStored wait_until_stored)
    : params_(params),
      narrow_phase_(std::move(narrow_phase)),
      prepare_(std::move(prepare)),
      change_world_(std::move(change_world)),
      wait_until_stored_(std::move(wait_until_stored)) {
  servers_.push_back(
      envelope.serve<msg::SaveScene>("save_scene", [this](ServiceCall<msg::SaveScene>& call) { save(call); }));
  servers_.push_back(
      envelope.serve<msg::LoadScene>("load_scene", [this](ServiceCall<msg::LoadScene>& call) { load(call); }));
  servers_.push_back(
      envelope.serve<msg::ListScenes>("list_scenes", [this](ServiceCall<msg::ListScenes>& call) { list(call); }));
}

void SceneFileServices::save(ServiceCall<msg::SaveScene>& call) const {
  const SceneFolder file(params_.state_folder, call.request.name);
  const auto obstacles = std::make_shared<std::shared_ptr<const PlacedObstacles>>();
  call.tick = AnswerTick(change_world_([obstacles](World& world) { *obstacles = world.obstacles().share(); }));
  const std::vector<PairRule>& rules = call.tick.snapshot().structure().filter.rules();
  file.write(sceneText(**obstacles, rules, params_), call.request.replace);
  call.response.path = file.path();
}

void SceneFileServices::list(ServiceCall<msg::ListScenes>& call) const {
  SceneList list = listScenes(params_.state_folder);
  for (const SceneList::Entry& scene : list.scenes) {
    call.response.names.push_back(scene.name);
    call.response.saved.push_back(rosTimeOf(scene.last_write));
  }
  call.response.unusable = std::move(list.unusable);
}

void SceneFileServices::load(ServiceCall<msg::LoadScene>& call) const {
  const SceneFolder file(params_.state_folder, call.request.name);
  const SavedScene scene = readScene(file.read(), call.request.name + ".yaml", params_);
  const Structure& structure = call.tick.snapshot().structure();
  const auto changes = std::make_shared<ObstacleChanges>();
  changes->without_groups = true;  // the file says where each obstacle of a group is
  changes->complete = call.request.replace;
  std::set<std::string> names;
  for (const ObstacleParams& obstacle : scene.obstacles) {
    ObstacleChange change;
    change.name = obstacle.body.name;
    change.added = requestedOf(obstacle, params_, *narrow_phase_);
    change.replace = true;
    changes->changes.push_back(change);
    names.insert(change.name);
    if (!obstacle.attached) continue;
    change.kind = ObstacleChange::Kind::attach;
    change.attachment = attachmentOf(obstacle);
    changes->changes.push_back(std::move(change));
  }
  const std::vector<PairRule> rules =
      rulesAfter(structure.filter.rules(), scene.rules, call.request.replace, call.caller, params_);
  checkNames(scene.rules, names, structure.bodies);  // takes long for many rules, so their number was checked before
  const auto next = std::make_shared<const PreparedRules>(
      PreparedRules{PairFilter(structure.bodies, params_.pair_kinds, rules), structure.revision});
  const auto matches = matchNames({names.begin(), names.end()}, next->filter);
  const std::shared_ptr<PreparedObstacles> prepared = prepare_(*changes, &rules);
  call.tick = AnswerTick(change_world_([changes, next, matches, prepared](World& world) {
    PreparedRules rules_now = *next;  // copied first, because nothing may fail after the obstacles were changed
    world.prepareNames(matches);
    world.applyObstacles(*changes, fromRos(ros::Time::now()), prepared.get());
    world.setRules(std::move(rules_now));
  }));
  call.response.durable = wait_until_stored_();
}

}  // namespace hgrid
