// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#include "hgrid_proximity/bodies/robot_model.h"

#include <cmath>
#include <limits>

namespace hgrid {

int RobotModel::find(const std::string& link) const {
  for (std::size_t i = 0; i < links.size(); ++i) {
    if (links[i].name == link) return static_cast<int>(i);
  }
  return -1;
}

void findRigidGroups(RobotModel& model) {
  model.group_roots.clear();
  for (std::uint32_t i = 0; i < model.links.size(); ++i) {
    RobotLink& link = model.links[i];
    if (link.parent >= 0 && link.joint_kind == JointKind::fixed) {
      const RobotLink& parent = model.links[static_cast<std::size_t>(link.parent)];
      link.rigid_group = parent.rigid_group;
      link.group_from_link = parent.group_from_link * link.parent_from_joint;
    } else {
      link.rigid_group = static_cast<std::uint32_t>(model.group_roots.size());
      link.group_from_link = Pose::Identity();
      model.group_roots.push_back(i);
    }
  }
}

double speedBound(const RobotModel& model, std::uint32_t link) {
  const double infinity = std::numeric_limits<double>::infinity();
  double reach = 0.0;  // [m] bound of the distance from the origin of link `at` (see the loop) to the points of `link`
  for (const BodyShape& shape : model.links[link].shapes) {
    reach = std::max(reach, shape.body_from_shape.translation().norm() + shape.shape.reach() + shape.padding);
  }
  if (reach == 0.0) return 0.0;  // the link has no shape, so no point can move
  const auto limitOf = [&](const RobotLink& at) { return at.max_velocity > 0.0 ? at.max_velocity : infinity; };
  double speed = 0.0;
  for (int at = static_cast<int>(link); model.links[static_cast<std::size_t>(at)].parent >= 0;) {
    const RobotLink& here = model.links[static_cast<std::size_t>(at)];
    switch (here.joint_kind) {
      case JointKind::fixed:
        break;
      case JointKind::revolute:
        speed += limitOf(here) * reach;
        break;
      case JointKind::prismatic:
        speed += limitOf(here);
        reach +=
            here.lower == 0.0 && here.upper == 0.0 ? infinity : std::max(std::abs(here.lower), std::abs(here.upper));
        break;
      case JointKind::planar:
      case JointKind::floating:
        return infinity;
    }
    reach += here.parent_from_joint.translation().norm();
    at = here.parent;
  }
  return speed;
}

}  // namespace hgrid
