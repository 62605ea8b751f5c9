// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#include "node/states/group_bodies.h"

#include "queries/doubtful_body.h"

namespace hgrid {

std::uint32_t groupAbove(const LoadedRobot& robot, std::uint32_t group) {
  const RobotModel& model = robot.read->model;
  const int parent = model.links[model.group_roots[group]].parent;
  return parent < 0 ? group : model.links[static_cast<std::size_t>(parent)].rigid_group;
}

std::map<std::string, std::uint32_t> groupsOfFrames(const LoadedRobot& robot) {
  const RobotModel& model = robot.read->model;
  const std::string prefix = robot.root_frame.substr(0, robot.root_frame.size() - model.links.front().name.size());
  std::map<std::string, std::uint32_t> groups;
  for (const RobotLink& link : model.links) groups[prefix + link.name] = link.rigid_group;
  return groups;
}

GroupBodies::GroupBodies(const LoadedRobot& robot, const Snapshot& snapshot)
    : robot_(robot), snapshot_(snapshot), below_(robot.groups.size()), has_bodies_(robot.groups.size()) {
  const std::map<std::string, std::uint32_t> group_of_frame = groupsOfFrames(robot);
  for (const Body& body : snapshot.structure().bodies) {
    if (body.kind != BodyKind::obstacle || body.mobility == Mobility::fixed) continue;
    const auto group = group_of_frame.find(body.frame);
    if (group != group_of_frame.end()) has_bodies_[group->second] = true;
  }
  for (auto group = static_cast<std::uint32_t>(robot.groups.size()); group-- > 0;) {  // a parent has a smaller index
    const std::uint32_t above = groupAbove(robot, group);
    if (!robot.groups[group].members.empty()) has_bodies_[group] = true;
    if (above == group) continue;
    below_[above].push_back(group);
    if (has_bodies_[group]) has_bodies_[above] = true;
  }
}

std::string GroupBodies::doubtAbout(std::uint32_t group) const {
  std::vector<std::uint32_t> open{group};
  while (!open.empty()) {
    const std::uint32_t next = open.back();
    open.pop_back();
    for (const auto& member : robot_.groups[next].members) {
      const std::uint32_t body = snapshot_.structure().find(robot_.bodies[member.first].name);
      if (body == Structure::kNone) return robot_.bodies[member.first].name + " is not in the world yet";
      if (snapshot_.poses()[body].state < Freshness::stale) continue;
      return doubtOf(snapshot_.structure().bodies[body], snapshot_.poses()[body]);
    }
    if (robot_.groups[next].members.empty()) open.insert(open.end(), below_[next].begin(), below_[next].end());
  }
  return {};
}

}  // namespace hgrid
