// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#include "node/world/robot_edits.h"

#include <memory>
#include <set>

#include "hgrid_proximity/refusal.h"

namespace hgrid {
namespace {

std::size_t sizeOf(const RobotDescription& text) {
  return text.urdf().size() + (text.srdf() ? text.srdf()->size() : 0);
}

/// Checks that there is room for one more robot. @throws Refusal limit
void checkRoom(const std::string& name, const RobotSpec& spec, const RobotEntries& robots, const Params& params) {
  if (robots.size() >= static_cast<std::size_t>(params.max_robots)) {
    throw Refusal(Code::limit, "robot '" + name + "' would be one robot too many; ~limits/max_robots is " +
                                   std::to_string(params.max_robots) + ": remove a robot, or raise the limit");
  }
  if (!spec.text) return;
  std::set<const RobotDescription*> texts{spec.text.get()};
  for (const auto& robot : robots) {
    if (robot.second.spec->text) texts.insert(robot.second.spec->text.get());
  }
  std::size_t bytes = 0;
  for (const RobotDescription* text : texts) bytes += sizeOf(*text);
  if (bytes <= static_cast<std::size_t>(params.max_description_bytes)) return;
  throw Refusal(Code::limit, "with robot '" + name + "', the descriptions that requests contained would have " +
                                 std::to_string(bytes) + " bytes together; at most " +
                                 std::to_string(params.max_description_bytes) +
                                 " are allowed (~limits/max_description_bytes): put the description into a parameter, or use "
                                 "like for an equal robot");
}

}  // namespace

bool isNeeded(RobotOperation operation, const std::string& name, const RobotSpec* spec, const RobotEntries& robots,
              const Params& params) {
  const auto known = robots.find(name);
  if (operation == RobotOperation::add) {
    if (known == robots.end()) {
      checkRoom(name, *spec, robots, params);
      return true;
    }
    const RobotEntry& robot = known->second;
    if (robot.inWorld() && isSame(*robot.spec, *spec)) return false;
    throw Refusal(Code::dup_id,
                  "there is a robot '" + name + "' already, " +
                      (robot.absent  ? "which was declared absent; declare it present, or remove it first"
                       : robot.model ? "with another description or tf_prefix; remove it first"
                                     : "which is not loaded yet; wait for its description, or remove it first"));
  }
  if (known == robots.end()) {
    throw Refusal(Code::unknown_id, "there is no robot '" + name +
                                        "'; see sources and absent_robots of ~status for the robots there are");
  }
  if (operation == RobotOperation::remove) return true;
  return known->second.absent != (operation == RobotOperation::declare_absent);
}

void edit(const RobotChange& change, const Params& params, RobotEntries& robots) {
  if (!isNeeded(change.operation, change.name, change.spec.get(), robots, params)) return;
  switch (change.operation) {
    case RobotOperation::add:
      robots[change.name] = {change.spec, change.model, false, ""};
      return;
    case RobotOperation::remove:
      robots.erase(change.name);
      return;
    case RobotOperation::declare_absent:
    case RobotOperation::declare_present:
      break;
  }
  RobotEntry& robot = robots.at(change.name);
  robot.absent = change.operation == RobotOperation::declare_absent;
  if (!robot.model) robot.model = change.model;
}

void checkSharesRoot(const LoadedRobot& robot, const std::string& world_frame) {
  const char* what_to_do = "; set ~world_frame to a frame that tf connects to all robots, and start the node again";
  if (world_frame.empty()) {
    throw Refusal(Code::not_ready, "robot '" + robot.name +
                                       "' cannot be added: ~world_frame is not set, and the first robot of ~robots, "
                                       "whose root is the world frame, is not loaded" +
                                       what_to_do);
  }
  if (robot.root_frame == world_frame) return;
  throw Refusal(Code::conflict, "robot '" + robot.name + "' cannot be added: its root is '" +
                                    printable(robot.root_frame) + "', but the world frame is '" +
                                    printable(world_frame) + "', the root of the first robot" + what_to_do);
}

}  // namespace hgrid
