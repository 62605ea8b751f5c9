// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#include "node/loading/robot_loader.h"

#include <ros/console.h>

#include <memory>
#include <utility>

#include "node/diagnostics/ledger.h"
#include "node/loading/missing_note.h"

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

RobotLoader::RobotLoader(const RobotSource& source, const Params& params, TickJobs& jobs, NodeHealth& health)
    : source_(source), params_(params), jobs_(jobs), health_(health), watch_(source, params) {
  for (const RobotParams& robot : params_.robots) missing_.put(robot.name, &robot);
}

void RobotLoader::loadMissing() {
  missing_.tryAll([this](const RobotParams* robot) { return load(*robot).code() == Code::ok; });
}

Refusal RobotLoader::reload(const std::string& name) {
  Refusal outcome(Code::unknown_id, "there is no robot '" + printable(name) + "' in ~robots");
  bool found = false;
  for (const RobotParams& robot : params_.robots) {
    if (!name.empty() && robot.name != name) continue;
    if (!std::exchange(found, true)) outcome = Refusal(Code::ok, "");
    const Refusal result = loadAgain(robot);
    if (result.code() != Code::ok) {
      outcome = Refusal(result.code(), "robot '" + robot.name + "': " + result.what());
    }
  }
  return outcome;
}

void RobotLoader::loadChanged() {
  for (const RobotParams* robot : watch_.changed()) {
    ROS_INFO("The description of robot '%s' has changed; it is loaded again.", robot->name.c_str());
    loadAgain(*robot);
  }
}

/// Loads a robot. If this fails and ~watch_descriptions is true, the next loadMissing() tries again.
Refusal RobotLoader::loadAgain(const RobotParams& robot) {
  const Refusal result = load(robot);
  if (result.code() == Code::ok) {
    missing_.remove(robot.name);
  } else if (params_.watch_descriptions) {
    missing_.put(robot.name, &robot);
  }
  return result;
}

/// Reads a robot and puts it into the world. @returns ok, or the reason of the failure
Refusal RobotLoader::load(const RobotParams& robot) {
  try {
    const RobotDescription description = source_.describe(robot);
    watch_.noteRead(robot, description);
    const auto loaded = std::make_shared<LoadedRobot>(source_.load(robot, description));
    const SelfPairs self_pairs = loaded->self_pairs;
    jobs_.run([loaded](World& world) { world.setRobot(std::move(*loaded)); });
    health_.noteLoaded(robot.name);
    logLoaded(robot.name, self_pairs);
    return {Code::ok, ""};
  } catch (...) {
    const Refusal why = caughtRefusal();
    noteFailed(robot, why);
    return why;
  }
}

void RobotLoader::noteFailed(const RobotParams& robot, const Refusal& why) {
  const std::string sentence = std::string(name(why.code())) + " robot '" + robot.name + "': " + why.what();
  noteMissing(jobs_, SourceId::ofRobot(robot.name), sentence);
  if (health_.noteFailedLoad(robot.name, sentence)) ROS_WARN("%s", sentence.c_str());
}

}  // namespace hgrid
