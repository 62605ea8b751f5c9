// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#include "node/loading/robot_loader.h"

#include <ros/console.h>

#include <memory>
#include <optional>
#include <utility>
#include <vector>

#include "node/health/ledger.h"
#include "node/loading/missing_note.h"
#include "node/world/robot_edits.h"
#include "node/world/world.h"

namespace hgrid {
namespace {

void logLoaded(const std::string& robot, const SelfPairs& self_pairs) {
  const std::string line = "Robot '" + robot + "' is loaded: " + text(self_pairs) + ".";
  if (self_pairs.looksWrong()) {
    ROS_WARN("%s", line.c_str());
  } else {
    ROS_INFO("%s", line.c_str());
  }
}

}  // namespace

RobotLoader::RobotLoader(const RobotSource& source, const Params& params, const RobotModels& robots,
                         PrepareRobots prepare_bodies, TickJobs& jobs, NodeHealth& health)
    : source_(source),
      params_(params),
      prepare_bodies_(std::move(prepare_bodies)),
      jobs_(jobs),
      health_(health),
      robots_(robots),
      watch_(source, params) {
  for (const RobotParams& robot : params_.robots) {  // the first one first, because its root may be the world frame
    const RobotEntry* entry = robots.entry(robot.name);
    if (entry != nullptr) missing_.put(robot.name, entry->spec);
  }
  adopt(robots);
}

void RobotLoader::loadMissing() {
  SharedReader reader(source_);
  missing_.tryAll([&](const Robot& robot) { return load(robot, reader).code() == Code::ok; });
}

Refusal RobotLoader::reload(const std::string& name) {
  Refusal outcome(Code::unknown_id, "there is no robot '" + printable(name) +
                                        "' in ~robots, and no request of ~apply_robots added one of this name");
  SharedReader reader(source_);
  bool found = false;
  const RobotModels robots = robots_;  // loadAgain() changes robots_
  for (const auto& [robot, entry] : robots.all()) {
    if (!name.empty() && robot != name) continue;
    if (!std::exchange(found, true)) outcome = Refusal(Code::ok, "");
    const Refusal result = loadAgain(entry.spec, reader);
    if (result.code() != Code::ok) {
      outcome = Refusal(result.code(), "robot '" + robot + "': " + result.what());
    }
  }
  return outcome;
}

void RobotLoader::loadChanged() {
  SharedReader reader(source_);
  for (const Robot& robot : watch_.changed()) {
    ROS_INFO("The description of robot '%s' has changed; it is loaded again.", robot->params.name.c_str());
    loadAgain(robot, reader);
  }
}

/// Loads a robot. If this fails and ~watch_descriptions is true, the next loadMissing() tries again.
Refusal RobotLoader::loadAgain(const Robot& robot, SharedReader& reader) {
  const Refusal result = load(robot, reader);
  if (result.code() == Code::ok) {
    missing_.remove(robot->params.name);
  } else if (params_.watch_descriptions && robots_.expects(robot->params.name)) {
    missing_.put(robot->params.name, robot);
  }
  return result;
}

/// Reads a robot and puts it into the world. @returns ok, or the reason of the failure
Refusal RobotLoader::load(const Robot& robot, SharedReader& reader) {
  const std::string& name = robot->params.name;
  try {
    const RobotDescription description = source_.describe(*robot);
    watch_.noteRead(name, description.hash());
    const auto loaded = std::make_shared<const LoadedRobot>(reader.load(*robot, description));
    const SelfPairs self_pairs = loaded->self_pairs;
    const auto after = std::make_shared<std::optional<RobotModels>>();
    const auto prepared = prepare_bodies_([&](RobotEntries& robots) { robots[loaded->name].model = loaded; });
    jobs_.run([loaded, prepared, after](World& world) {
      world.setRobot(loaded, prepared.get());
      after->emplace(world.robots());
    });
    robots_.swap(**after);
    health_.noteLoaded(name);
    logLoaded(name, self_pairs);
    return {Code::ok, ""};
  } catch (...) {
    const Refusal why = caughtRefusal();
    noteFailed(*robot, why);
    return why;
  }
}

void RobotLoader::noteFailed(const RobotSpec& robot, const Refusal& why) {
  const std::string& name = robot.params.name;
  const std::string sentence = std::string(hgrid::name(why.code())) + " robot '" + name + "': " + why.what();
  noteMissing(jobs_, SourceId::ofRobot(name), sentence);
  if (!robots_.expects(name)) return;  // nobody waits for an absent robot
  if (health_.noteFailedLoad(name, sentence)) ROS_WARN("%s", sentence.c_str());
}

PreparedRobots RobotLoader::prepare(const std::vector<RobotRequest>& requests) const {
  return hgrid::prepare(requests, robots_.all(), source_, params_);
}

std::shared_ptr<PreparedRobotBodies> RobotLoader::prepareBodies(const RobotChanges& changes) const {
  return prepare_bodies_([&](RobotEntries& robots) {
    for (const RobotChange& change : changes) edit(change, params_, robots);
  });
}

std::shared_ptr<const Tick> RobotLoader::change(const ChangeWorld& change_world, const std::function<void(World&)>& act,
                                                const PreparedRobots* prepared) {
  const auto after = std::make_shared<std::optional<RobotModels>>();
  const auto adoptAll = [&] {
    if (!*after) return;
    adopt(**after);
    if (prepared == nullptr) return;
    for (const auto& [robot, hash] : prepared->read) watch_.noteRead(robot, hash);
    for (const auto& [robot, other] : prepared->like) watch_.noteLike(robot, other);
  };
  std::shared_ptr<const Tick> tick;
  try {
    tick = change_world([act, after](World& world) {
      act(world);
      after->emplace(world.robots());
    });
  } catch (...) {
    adoptAll();  // the change may have been made, although no tick told of it in time
    throw;
  }
  adoptAll();
  return tick;
}

/// Adapts what is to be loaded and watched to the robots of the world. Absent robots are loaded, too, so that their
/// models are there when they are needed.
void RobotLoader::adopt(const RobotModels& robots) {
  for (const auto& robot : robots_.all()) {
    if (robots.entry(robot.first) == nullptr) missing_.remove(robot.first);
    if (!robots.expects(robot.first)) health_.noteLoaded(robot.first);  // ends the report of a failed load
  }
  DescriptionWatch::Robots watched;
  for (const auto& [name, robot] : robots.all()) {
    watched.push_back(robot.spec);
    const Robot* pending = missing_.find(name);
    const bool is_old = !robot.refused.empty() && !robot.absent && params_.watch_descriptions;
    if (robot.model && !is_old) {
      missing_.remove(name);
    } else if (pending == nullptr || *pending != robot.spec) {
      missing_.put(name, robot.spec);
      newly_missing_ = true;
    }
  }
  watch_.setRobots(std::move(watched));
  RobotModels copy = robots;
  robots_.swap(copy);
}

}  // namespace hgrid
