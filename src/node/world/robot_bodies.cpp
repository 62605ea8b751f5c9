// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#include "node/world/robot_bodies.h"

#include <algorithm>
#include <cstddef>
#include <map>
#include <set>
#include <utility>

#include "hgrid_proximity/refusal.h"
#include "node/sources/obstacle_change.h"
#include "node/world/robot_edits.h"

namespace hgrid {
namespace {

/// Returns the robots of `next` that must enter the scene, because it does not have them or has another model of them.
RobotList entering(const RobotEntries& present, const RobotEntries& next) {
  RobotList robots;
  for (const auto& [name, robot] : next) {
    const auto old = present.find(name);
    const bool stays = old != present.end() && old->second.inWorld() && old->second.model == robot.model;
    if (robot.inWorld() && !stays) robots.push_back(robot.model);
  }
  return robots;
}

/// Returns the names of the robots that must leave the scene.
std::set<std::string> leaving(const RobotEntries& present, const RobotEntries& next) {
  std::set<std::string> names;
  for (const auto& robot : entering(next, present)) names.insert(robot->name);
  return names;
}

Refusal tooLarge(const LoadedRobot& robot, const Params& params) {
  return {Code::limit, "robot '" + robot.name + "' has " + std::to_string(robot.bodies.size()) +
                           " bodies; with them, the world would have more than ~limits/max_bodies, " +
                           std::to_string(params.max_bodies)};
}

/// Returns what a robot lacks; empty: nothing, or it is not expected to be in the world.
std::string lackOf(const std::string& name, const RobotEntry& robot) {
  if (robot.absent) return {};
  if (!robot.model) return "NOT_READY robot '" + name + "': its description has not been read yet";
  if (!robot.refused.empty()) {
    return "REFUSED '" + name + "': its newest description could not be used (" + robot.refused +
           "), so its model may be out of date";
  }
  return robot.model->gap.empty() ? "" : "UNCOVERED " + robot.model->gap;
}

bool isSameEntry(const RobotEntry& a, const RobotEntry& b) {
  return a.spec == b.spec && a.model == b.model && a.absent == b.absent && a.refused == b.refused;
}

/// Updates what the robots lack. What is known of a robot that does not change stays.
void updateMissing(const RobotEntries& present, const RobotEntries& next, MissingSources& missing) {
  for (const auto& robot : present) {
    if (next.count(robot.first) == 0) missing.erase(SourceId::ofRobot(robot.first));
  }
  for (const auto& [name, robot] : next) {
    const auto old = present.find(name);
    if (old != present.end() && isSameEntry(old->second, robot)) continue;
    const std::string lack = lackOf(name, robot);
    lack.empty() ? missing.erase(SourceId::ofRobot(name)) : missing.set(SourceId::ofRobot(name), lack);
  }
}

/// Adds a mover for each group of links that move together.
void addMovers(const LoadedRobot& robot, const LinkPaddings& paddings, NewMovers& coming) {
  const SourceId source = SourceId::ofRobot(robot.name);
  for (const LoadedRobot::Group& group : robot.groups) {
    bool first = true;
    for (const auto& [body, frame_from_body] : group.members) {
      if (std::exchange(first, false)) {
        coming.add(group.frame, source, padded(robot.bodies[body], paddings), frame_from_body);
      } else {
        coming.join(padded(robot.bodies[body], paddings), frame_from_body);
      }
    }
  }
}

}  // namespace

RobotBodies::RobotBodies(const Params& params, const StoredRobots& stored, const Scene& scene, Movers& movers,
                         MissingSources& missing)
    : params_(params), scene_(scene), movers_(movers), missing_(missing), models_(params, stored) {
  updateMissing({}, models_.all(), missing_);
}

void RobotBodies::set(std::shared_ptr<const LoadedRobot> robot, PreparedRobotBodies* prepared) {
  RobotEntries next = models_.all();
  RobotEntry& entry = next[robot->name];
  if (!entry.spec) {
    RobotSpec spec;
    spec.params.name = robot->name;
    entry.spec = std::make_shared<const RobotSpec>(std::move(spec));
  }
  entry.model = robot;
  entry.refused.clear();
  if (const LoadedRobot* large = findTooLarge(next)) throw tooLarge(*large, params_);
  exchange(std::move(next), prepared);
}

void RobotBodies::apply(const RobotChanges& changes, const std::string& world_frame, PreparedRobotBodies* prepared) {
  RobotEntries next = models_.all();
  std::map<std::string, std::size_t> bringing;  // index of the last change that brings a robot into the world, by name
  for (const RobotChange& change : changes) {
    try {
      edit(change, params_, next);
      if (change.operation == RobotOperation::add && params_.world_frame.empty())
        checkSharesRoot(*change.model, world_frame);
    } catch (const Refusal& refusal) {
      throw ChangeRefusal(change.index, refusal);
    }
    if (next.count(change.name) != 0) bringing[change.name] = change.index;
  }
  if (const LoadedRobot* robot = findTooLarge(next))
    throw ChangeRefusal(bringing[robot->name], tooLarge(*robot, params_));
  exchange(std::move(next), prepared);
}

void RobotBodies::noteRefused(const std::string& name, const std::string& sentence) {
  const RobotEntry* known = models_.entry(name);
  if (known == nullptr) return;
  if (!known->model && !known->absent) missing_.set(SourceId::ofRobot(name), sentence);
  if (!known->model || known->refused == sentence) return;
  RobotEntries next = models_.all();
  next.at(name).refused = sentence;
  exchange(std::move(next), nullptr);
}

void RobotBodies::reset(const std::function<bool(const SourceId&)>& leaves_too) {
  exchange(models_.configured(), nullptr, leaves_too);
}

/// Returns the first robot with which the world would have more than ~limits/max_bodies bodies; null: there is none.
/// @param next  all robots after the change; those that are in the world already have room
const LoadedRobot* RobotBodies::findTooLarge(const RobotEntries& next) const {
  std::size_t count = scene_.size();
  for (const auto& robot : entering(next, models_.all())) count -= robot->bodies.size();  // these leave
  for (const auto& robot : entering(models_.all(), next)) {
    count += robot->bodies.size();
    if (count > static_cast<std::size_t>(params_.max_bodies)) return robot.get();
  }
  return nullptr;
}

std::shared_ptr<PreparedRobotBodies> RobotBodies::prepare(const RobotEntries& before, const RobotEntries& after,
                                                          const Snapshot& newest, const Scene& scene) {
  auto prepared = std::make_shared<PreparedRobotBodies>();
  prepared->leaving = leaving(before, after);
  prepared->coming = entering(before, after);
  for (const auto& robot : prepared->coming) addMovers(*robot, {}, prepared->movers);
  std::vector<std::string> out;
  for (const Body& body : newest.structure().bodies) {
    if (body.kind == BodyKind::link && prepared->leaving.count(body.robot) != 0) out.push_back(body.name);
  }
  if (!out.empty() || !prepared->coming.empty()) prepared->movers.prepare(scene, newest, out, std::nullopt);
  return prepared;
}

/// Replaces the robots, all of them or none.
/// @param prepared    used if it was made for this change; null: none
/// @param leaves_too  which other sources leave the world; null: none
void RobotBodies::exchange(RobotEntries next, PreparedRobotBodies* prepared,
                           const std::function<bool(const SourceId&)>& leaves_too) {
  const RobotEntries& present = models_.all();
  const std::set<std::string> out = leaving(present, next);
  const RobotList coming = entering(present, next);
  MissingSources missing = missing_;
  updateMissing(present, next, missing);
  RobotModels models = models_;
  models.set(std::move(next));
  if (leaves_too || !out.empty() || !coming.empty()) {
    const auto leaves = [&](const SourceId& source) {
      return (source.kind == SourceKind::robot && out.count(source.name) != 0) || (leaves_too && leaves_too(source));
    };
    NewMovers made_now;
    const bool is_prepared = prepared != nullptr && paddings_.empty() && !leaves_too && prepared->leaving == out &&
                             prepared->coming == coming;
    if (!is_prepared) made_now = moversOf(coming);
    movers_.exchange(leaves, is_prepared ? std::move(prepared->movers) : std::move(made_now));
  }
  // The code below does not throw.
  models_.swap(models);
  missing_.swap(missing);
}

/// Returns the movers of robots, with the paddings of their links.
NewMovers RobotBodies::moversOf(const RobotList& coming) const {
  NewMovers movers;
  for (const auto& robot : coming) addMovers(*robot, paddings_, movers);
  return movers;
}

void RobotBodies::setPaddings(LinkPaddings paddings) noexcept {
  paddings_changed_ = paddings_changed_ || paddings != paddings_;
  paddings_.swap(paddings);
}

void RobotBodies::padLinks() {
  if (!paddings_changed_) return;
  const auto differs = [this](const Body& link) { return hasOtherPadding(link); };
  RobotList robots;
  std::set<SourceId> sources;
  for (const auto& [name, robot] : models_.all()) {
    if (!robot.inWorld() || std::none_of(robot.model->bodies.begin(), robot.model->bodies.end(), differs)) continue;
    robots.push_back(robot.model);
    sources.insert(SourceId::ofRobot(name));
  }
  if (!robots.empty()) {
    movers_.exchange([&](const SourceId& source) { return sources.count(source) != 0; }, moversOf(robots));
  }
  paddings_changed_ = false;
}

/// Returns whether a link in the world has another padding than it should have.
bool RobotBodies::hasOtherPadding(const Body& link) const {
  BodyId id;
  if (!scene_.find(link.name, id)) return false;
  const std::vector<BodyShape>& now = scene_.body(id).shapes;
  const std::vector<BodyShape> next = padded(link, paddings_).shapes;
  return !std::equal(now.begin(), now.end(), next.begin(), next.end(),
                     [](const BodyShape& a, const BodyShape& b) { return a.padding == b.padding; });
}

}  // namespace hgrid
