// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#include "hgrid_proximity/bodies/robot_model.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "geometry/infinity.h"
#include "hgrid_proximity/bodies/name.h"

namespace hgrid {
namespace {

constexpr std::size_t kLongestMimicry = 8;  // joints that follow each other

/// How a joint can move.
struct Travel {
  double speed = kInfinity;  ///< [rad/s] or [m/s] upper bound of its speed
  double range = kInfinity;  ///< [rad] or [m] upper bound of the absolute value of its position
};

Travel travelByLimits(const RobotLink& link) {
  Travel travel;
  if (link.max_velocity > 0.0) travel.speed = link.max_velocity;
  const bool has_limits = !link.continuous && (link.lower != 0.0 || link.upper != 0.0);
  if (has_limits) travel.range = std::max(std::abs(link.lower), std::abs(link.upper));
  return travel;
}

/// Follows a chain of joints that mimic each other to the joint that moves by itself.
Travel travelOf(const RobotModel& model, const RobotLink& link) {
  const RobotLink* at = &link;
  double factor = 1.0, offset = 0.0;
  for (std::size_t steps = 0; !at->mimic.empty(); ++steps) {
    if (steps == kLongestMimicry) return {};  // a circle, or a chain that no robot has
    const auto leader = std::find_if(model.links.begin(), model.links.end(),
                                     [&](const RobotLink& other) { return other.joint == at->mimic; });
    if (leader == model.links.end()) return {};
    offset += factor * std::abs(at->mimic_offset);
    factor *= std::abs(at->mimic_multiplier);
    at = &*leader;
  }
  if (factor == 0.0) return {0.0, offset};
  const Travel travel = travelByLimits(*at);
  return {factor * travel.speed, factor * travel.range + offset};
}

}  // namespace

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

double reachOf(const std::vector<BodyShape>& shapes) {
  double reach = 0.0;
  for (const BodyShape& shape : shapes) {
    reach = std::max(reach, shape.body_from_shape.translation().norm() + shape.shape.reach() + shape.padding);
  }
  return reach;
}

LinkSpeed linkSpeed(const RobotModel& model, std::uint32_t link, double reach) {
  LinkSpeed speed;
  if (reach == 0.0) return speed;
  bool is_reach_known = true;  // false: `reach` counts only what is known of it
  for (int at = static_cast<int>(link); model.links[static_cast<std::size_t>(at)].parent >= 0;) {
    const RobotLink& here = model.links[static_cast<std::size_t>(at)];
    Travel travel{0.0, 0.0};
    double lever = 1.0;
    switch (here.joint_kind) {
      case JointKind::fixed:
        break;
      case JointKind::revolute:
        travel = {travelOf(model, here).speed, 0.0};
        lever = reach;
        speed.is_bound = speed.is_bound && (is_reach_known || travel.speed == 0.0);
        break;
      case JointKind::prismatic:
        travel = travelOf(model, here);
        break;
      case JointKind::planar:
      case JointKind::floating:
        travel = {};
        break;
    }
    if (std::isfinite(travel.speed)) speed.limited += travel.speed * lever;
    if (std::isfinite(travel.range)) reach += travel.range;
    speed.is_bound = speed.is_bound && std::isfinite(travel.speed);
    is_reach_known = is_reach_known && std::isfinite(travel.range);
    reach += here.parent_from_joint.translation().norm();
    at = here.parent;
  }
  return speed;
}

double speedBound(const RobotModel& model, std::uint32_t link, double reach) {
  const LinkSpeed speed = linkSpeed(model, link, reach);
  return speed.is_bound ? speed.limited : kInfinity;
}

double speedBound(const RobotModel& model, std::uint32_t link) {
  return speedBound(model, link, reachOf(model.links[link].shapes));
}

Body linkBody(const RobotModel& model, std::uint32_t link, const std::string& robot,
              std::shared_ptr<const LinkMatrix> links) {
  const RobotLink& source = model.links[link];
  Body body;
  body.name = joined(robot, source.name);
  body.frame = source.name;
  body.kind = BodyKind::link;
  body.robot = robot;
  body.link = link;
  body.rigid_group = source.rigid_group;
  body.links = std::move(links);
  body.shapes = source.shapes;
  body.covered = source.unreadable.empty();
  for (const Refusal& refusal : source.unreadable) {
    body.note += (body.note.empty() ? "" : "; ") + std::string(name(refusal.code())) + ": " + refusal.what();
  }
  return body;
}

}  // namespace hgrid
