// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#include "node/states/followers.h"

#include <set>

#include "node/states/group_bodies.h"

namespace hgrid {
namespace {

/// Returns for each rigid group whether a state moves it.
std::vector<bool> movedGroups(const LoadedRobot& robot, const std::map<std::string, double>& given, bool moves_root) {
  const RobotModel& model = robot.read->model;
  std::vector<bool> moved(robot.groups.size());
  moved[0] = moves_root;
  for (std::uint32_t group = 1; group < moved.size(); ++group) {
    const RobotLink& link = model.links[model.group_roots[group]];
    std::vector<JointVariable> own;
    appendVariables(link, own);
    moved[group] = moved[groupAbove(robot, group)] || (!link.mimic.empty() && !given.empty());
    for (const JointVariable& variable : own) moved[group] = moved[group] || given.count(variable.name) > 0;
  }
  return moved;
}

}  // namespace

std::string followerOf(const LoadedRobot& robot, const std::map<std::string, double>& given, bool moves_root,
                       const std::string& placed, const Tick& tick, const TransformLookup& transforms) {
  std::map<std::string, std::uint32_t> own = groupsOfFrames(robot);
  own.erase(tick.world_frame);
  const std::vector<bool> moved = movedGroups(robot, given, moves_root);
  std::set<std::string> seen;
  // StateChecker moves obstacles in the frame of a link, but no robots and maps in such a frame.
  const auto follows = [&](const std::string& frame, bool is_obstacle) {
    const auto link = own.find(frame);
    if (link != own.end()) return !is_obstacle && moved[link->second];
    if (frame == tick.world_frame || !seen.insert(frame).second) return false;
    const std::string above = transforms.nearestAbove(frame, own);
    return !above.empty() && moved[own.at(above)];
  };
  const auto sentence = [&](const std::string& body, const std::string& frame) {
    return body + " follows frame '" + printable(frame) + "', which moves with robot '" + robot.name +
           "'; its pose in the state is not known";
  };
  for (const auto& [name, entry] : *tick.robots) {
    if (!entry.inWorld() || name == robot.name || name == placed) continue;
    if (follows(entry.model->root_frame, false)) return sentence("robot '" + name + "'", entry.model->root_frame);
  }
  for (const Body& body : tick.snapshot->structure().bodies) {
    const bool may_follow = body.kind == BodyKind::obstacle || body.kind == BodyKind::map;
    if (!may_follow || body.mobility == Mobility::fixed) continue;
    if (follows(body.frame, body.kind == BodyKind::obstacle)) return sentence(body.name, body.frame);
  }
  return {};
}

}  // namespace hgrid
