// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#include "node/states/robot_choice.h"

#include <algorithm>

namespace hgrid {
namespace {

/// Whether a robot has a variable, a joint or a virtual joint of this name.
bool hasJoint(const LoadedRobot& robot, const std::string& name) {
  const RobotJoints& joints = *robot.read->joints;
  const std::string joint = jointOf(name, robot.name);
  if (joints.groups.findVirtual(joint) != nullptr) return true;
  const std::vector<RobotLink>& links = robot.read->model.links;
  return joints.kinematics->find(joint) >= 0 || std::any_of(links.begin(), links.end(), [&](const RobotLink& link) {
           return link.joint_kind != JointKind::fixed && link.joint == joint;
         });
}

bool hasGroup(const LoadedRobot& robot, const std::string& group) {
  const std::vector<JointGroup>& groups = robot.read->joints->groups.groups;
  return std::any_of(groups.begin(), groups.end(), [&](const JointGroup& one) { return one.name == group; });
}

std::string listed(const std::vector<const LoadedRobot*>& robots) {
  std::string names;
  for (const LoadedRobot* robot : robots) names += (names.empty() ? "" : ", ") + robot->name;
  return names;
}

/// Returns the sentence that says why no robot fits.
std::string whyNone(const std::vector<const LoadedRobot*>& robots, const std::vector<std::string>& joints,
                    const std::string& group) {
  for (const std::string& name : joints) {
    if (std::any_of(robots.begin(), robots.end(), [&](const LoadedRobot* robot) { return hasJoint(*robot, name); }))
      continue;
    return "no robot has the joint '" + printable(name) + "'; the robots are " + listed(robots);
  }
  const auto has_group = [&](const LoadedRobot* robot) { return hasGroup(*robot, group); };
  if (!group.empty() && std::none_of(robots.begin(), robots.end(), has_group)) {
    return "the SRDF of no robot has the group '" + printable(group) + "'; the robots are " + listed(robots);
  }
  return "the joints and the group of the request are those of different robots (" + listed(robots) +
         "); a request must be about one robot";
}

}  // namespace

std::string jointOf(const std::string& name, const std::string& robot) {
  const bool has_robot = name.size() > robot.size() + 1 && name[robot.size()] == '/' && name.rfind(robot, 0) == 0;
  return has_robot ? name.substr(robot.size() + 1) : name;
}

const LoadedRobot& robotWith(const std::vector<std::string>& joints, const std::string& group, const Tick& tick) {
  std::vector<const LoadedRobot*> present, usable;
  for (const auto& [name, entry] : *tick.robots) {
    if (!entry.inWorld()) continue;
    present.push_back(entry.model.get());
    if (entry.model->read->joints->kinematics) usable.push_back(entry.model.get());
  }
  if (present.empty()) throw Refusal(Code::not_ready, "no robot is in the world; its joints are not known");
  if (usable.empty()) {
    throw Refusal(Code::not_ready, "states of robot '" + present.front()->name +
                                       "' cannot be checked: " + present.front()->read->joints->flaw);
  }
  std::vector<const LoadedRobot*> fitting;
  for (const LoadedRobot* robot : usable) {
    const bool has_all =
        std::all_of(joints.begin(), joints.end(), [&](const std::string& name) { return hasJoint(*robot, name); });
    if (has_all && (group.empty() || hasGroup(*robot, group))) fitting.push_back(robot);
  }
  if (fitting.empty()) throw Refusal(Code::unknown_id, whyNone(usable, joints, group));
  if (fitting.size() == 1) return *fitting.front();
  if (joints.empty() && group.empty()) {
    for (const RobotParams& first : tick.settings->params.robots) {
      for (const LoadedRobot* robot : fitting) {
        if (robot->name == first.name) return *robot;
      }
    }
    return *fitting.front();
  }
  throw Refusal(Code::conflict, "several robots (" + listed(fitting) +
                                    ") have the joints of the request; write their names as robot/joint");
}

}  // namespace hgrid
