// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#include "node/states/present_joints.h"

#include <algorithm>

namespace hgrid {

std::vector<double> presentJoints(const LoadedRobot& robot, const std::map<std::string, double>& given,
                                  const TransformLookup& transforms, Time time, double max_apart) {
  const RobotModel& model = robot.read->model;
  std::vector<double> values;
  for (const RobotLink& link : model.links) {
    if (link.joint_kind == JointKind::fixed || !link.mimic.empty()) continue;
    std::vector<JointVariable> own;
    appendVariables(link, own);
    const bool is_given = std::all_of(own.begin(), own.end(),
                                      [&](const JointVariable& variable) { return given.count(variable.name) > 0; });
    const RobotLink& parent = model.links[static_cast<std::size_t>(link.parent)];
    Pose parent_from_link = link.parent_from_joint;
    if (!is_given) {
      const Pose group_from_link = transforms.atOrNewest(
          robot.groups[parent.rigid_group].frame, robot.groups[link.rigid_group].frame, time, max_apart,
          "the frame '" + printable(robot.groups[link.rigid_group].frame) + "' behind joint '" + printable(link.joint) +
              "'");
      parent_from_link = parent.group_from_link.inverse() * group_from_link;
    }
    appendValues(link, parent_from_link, values);
    for (std::size_t i = 0; i < own.size(); ++i) {
      const auto value = given.find(own[i].name);
      if (value != given.end()) values[values.size() - own.size() + i] = value->second;
    }
  }
  return values;
}

std::optional<Pose> rootWithoutBody(const LoadedRobot& robot, const std::string& world_frame,
                                    const TransformLookup& transforms, Time time, double max_apart) {
  const LoadedRobot::Group& root = robot.groups.front();
  if (!root.members.empty()) return std::nullopt;
  if (root.frame == world_frame) return Pose::Identity();
  return transforms.atOrNewest(world_frame, root.frame, time, max_apart,
                               "the root frame '" + printable(root.frame) + "' of robot '" + robot.name + "'");
}

}  // namespace hgrid
