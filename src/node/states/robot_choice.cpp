// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#include "node/states/robot_choice.h"

#include <algorithm>
#include <set>

namespace hgrid {
namespace {

constexpr std::size_t kMostListed = 10;  // number of names in a sentence

/// The names that requests may use for the joints and groups of a robot.
struct Names {
  explicit Names(const LoadedRobot& of) : robot(of) {
    for (const RobotLink& link : of.read->model.links) {
      if (link.joint_kind == JointKind::fixed) continue;
      joints.insert(link.joint);
      std::vector<JointVariable> own;
      appendVariables(link, own);
      for (const JointVariable& variable : own) joints.insert(variable.name);
    }
    for (const VirtualJoint& joint : of.read->joints->groups.virtual_joints) joints.insert(joint.name);
    for (const JointGroup& group : of.read->joints->groups.groups) groups.insert(group.name);
  }
  bool hasJoint(const std::string& name) const { return joints.count(jointOf(name, robot.name)) > 0; }
  bool hasAll(const std::vector<std::string>& names, const std::string& group) const {
    return (group.empty() || groups.count(group) > 0) &&
           std::all_of(names.begin(), names.end(), [&](const std::string& name) { return hasJoint(name); });
  }

  const LoadedRobot& robot;
  std::set<std::string> joints, groups;
};

std::string listed(const std::vector<Names>& robots) {
  std::string names;
  for (std::size_t i = 0; i < std::min(robots.size(), kMostListed); ++i) {
    names += (i == 0 ? "" : ", ") + robots[i].robot.name;
  }
  if (robots.size() > kMostListed) names += " and " + std::to_string(robots.size() - kMostListed) + " more";
  return names;
}

/// Returns the sentence that says why no robot fits.
std::string whyNone(const std::vector<Names>& robots, const std::vector<std::string>& joints,
                    const std::string& group) {
  for (const std::string& name : joints) {
    if (std::any_of(robots.begin(), robots.end(), [&](const Names& one) { return one.hasJoint(name); })) continue;
    return "no robot has the joint '" + printable(name) + "'; the robots are " + listed(robots);
  }
  const auto has_group = [&](const Names& one) { return one.groups.count(group) > 0; };
  if (!group.empty() && std::none_of(robots.begin(), robots.end(), has_group)) {
    std::string flaws;
    for (const Names& one : robots) {
      const std::string& flaw = one.robot.read->joints->group_flaw;
      if (!flaw.empty() && flaws.empty()) flaws = "; the groups of '" + one.robot.name + "' cannot be used: " + flaw;
    }
    return "the SRDF of no robot has the group '" + printable(group) + "'; the robots are " + listed(robots) + flaws;
  }
  return "the joints and the group of the request are those of different robots (" + listed(robots) +
         "); a request must be about one robot";
}

/// Returns the robot that a request without names means.
const LoadedRobot& onlyRobot(const Tick& tick) {
  if (!tick.settings->params.robots.empty()) {
    const std::string& first = tick.settings->params.robots.front().name;
    const auto found = tick.robots->find(first);
    if (found != tick.robots->end() && found->second.inWorld()) return *found->second.model;
    throw Refusal(Code::not_ready, "robot '" + first + "', the first of ~robots, is not in the world");
  }
  const LoadedRobot* only = nullptr;
  for (const auto& [name, entry] : *tick.robots) {
    if (!entry.inWorld()) continue;
    if (only != nullptr) throw Refusal(Code::conflict, "there are several robots; name the joints of one of them");
    only = entry.model.get();
  }
  if (only == nullptr) throw Refusal(Code::not_ready, "no robot is in the world");
  return *only;
}

const LoadedRobot& usable(const LoadedRobot& robot) {
  const RobotJoints& joints = *robot.read->joints;
  if (!joints.kinematics) {
    throw Refusal(Code::not_ready, "states of robot '" + robot.name + "' cannot be checked: " + joints.flaw);
  }
  if (robot.bodies.empty()) {
    throw Refusal(Code::not_ready, "robot '" + robot.name + "' has no link with geometry; nothing can be checked");
  }
  return robot;
}

}  // namespace

std::string jointOf(const std::string& name, const std::string& robot) {
  const bool has_robot = name.size() > robot.size() + 1 && name[robot.size()] == '/' && name.rfind(robot, 0) == 0;
  return has_robot ? name.substr(robot.size() + 1) : name;
}

const LoadedRobot& robotWith(const std::vector<std::string>& joints, const std::string& group, const Tick& tick) {
  if (joints.empty() && group.empty()) return usable(onlyRobot(tick));
  const std::size_t most = 8 * static_cast<std::size_t>(tick.settings->params.max_links);  // a joint has up to 7 values
  if (joints.size() > most) {
    throw Refusal(Code::limit, "the request has " + std::to_string(joints.size()) + " joints; at most " +
                                   std::to_string(most) + " are allowed (8 times ~limits/max_links)");
  }
  std::vector<Names> present;
  for (const auto& [name, entry] : *tick.robots) {
    if (entry.inWorld()) present.emplace_back(*entry.model);
  }
  if (present.empty()) throw Refusal(Code::not_ready, "no robot is in the world; its joints are not known");
  std::vector<Names> fitting;
  for (const Names& robot : present) {
    if (robot.hasAll(joints, group)) fitting.push_back(robot);
  }
  if (fitting.empty()) throw Refusal(Code::unknown_id, whyNone(present, joints, group));
  if (fitting.size() == 1) return usable(fitting.front().robot);
  throw Refusal(Code::conflict, "several robots (" + listed(fitting) +
                                    ") have the joints of the request; write their names as robot/joint");
}

const LoadedRobot& robotNamed(const std::string& name, const Tick& tick) {
  const auto found = tick.robots->find(name);
  if (found == tick.robots->end()) {
    std::string known;
    std::size_t count = 0;
    for (const auto& [other, entry] : *tick.robots) {
      if (++count <= kMostListed) known += (known.empty() ? "" : ", ") + other;
    }
    if (count > kMostListed) known += " and " + std::to_string(count - kMostListed) + " more";
    throw Refusal(Code::unknown_id, "there is no robot '" + printable(name) + "'; " +
                                        (known.empty() ? "there are no robots" : "the robots are " + known));
  }
  if (!found->second.inWorld()) throw Refusal(Code::not_ready, "robot '" + name + "' is not in the world");
  return usable(*found->second.model);
}

}  // namespace hgrid
