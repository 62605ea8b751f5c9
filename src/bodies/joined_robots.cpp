// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#include "hgrid_proximity/bodies/joined_robots.h"

namespace hgrid {

RobotModel joinRobots(const std::vector<JoinedRobot>& robots) {
  RobotModel joined;
  joined.links.emplace_back();
  for (const JoinedRobot& robot : robots) {
    joined.name += (joined.name.empty() ? "" : " and ") + robot.name;
    const auto first = static_cast<int>(joined.links.size());
    for (RobotLink link : robot.model->links) {
      link.name = robot.name + "/" + link.name;
      if (!link.joint.empty()) link.joint = robot.name + "/" + link.joint;
      if (!link.mimic.empty()) link.mimic = robot.name + "/" + link.mimic;
      if (link.parent < 0) {
        link.parent = 0;
        link.joint_kind = JointKind::fixed;
        link.parent_from_joint = robot.world_from_root;
      } else {
        link.parent += first;
      }
      joined.links.push_back(std::move(link));
    }
  }
  findRigidGroups(joined);
  return joined;
}

}  // namespace hgrid
