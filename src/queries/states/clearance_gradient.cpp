// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#include "queries/states/clearance_gradient.h"

#include <algorithm>

namespace hgrid {
namespace {

/// A robot in one of four states.
struct Placed {
  const std::vector<JointMotion>& joints;
  const std::vector<FourPoses>& groups;
  const std::vector<FourDoubles>& values;
  std::size_t lane;

  Pose worldFrom(std::uint32_t group) const { return groups[group].of(lane); }
};

/// Adds how a turn about an axis through `center` moves a point along a direction.
double turned(const Eigen::Vector3d& axis, const Eigen::Vector3d& center, const Eigen::Vector3d& point,
              const Eigen::Vector3d& direction) {
  return direction.dot(axis.cross(point - center));
}

/// Adds the velocity of a point along a direction, for each variable of a floating joint.
void addFloating(const Placed& robot, std::uint32_t group, const Eigen::Vector3d& point,
                 const Eigen::Vector3d& direction, std::vector<double>& gradient) {
  const JointMotion& joint = robot.joints[group];
  const Eigen::Matrix3d world_from_joint = robot.worldFrom(joint.parent).linear() * joint.parent_from_plane.linear();
  const Eigen::Vector3d center = robot.worldFrom(group).translation();
  const auto value = [&](std::size_t part) { return robot.values[joint.variable + part][robot.lane]; };
  const Eigen::Quaterniond turn(value(6), value(3), value(4), value(5));
  for (std::size_t i = 0; i < 3; ++i) {
    gradient[joint.variable + i] += direction.dot(world_from_joint.col(static_cast<Eigen::Index>(i)));
  }
  for (std::size_t i = 0; i < 4; ++i) {  // the order is x, y, z, w
    Eigen::Quaterniond change(0.0, 0.0, 0.0, 0.0);
    change.coeffs()[static_cast<Eigen::Index>(i)] = 1.0;
    const Eigen::Vector3d axis = 2.0 / turn.squaredNorm() * (change * turn.conjugate()).vec();
    gradient[joint.variable + 3 + i] += turned(world_from_joint * axis, center, point, direction);
  }
}

/// Adds the velocity of a point of a rigid group along a direction, for each variable.
void addVelocity(const Placed& robot, std::uint32_t group, const Eigen::Vector3d& point,
                 const Eigen::Vector3d& direction, std::vector<double>& gradient) {
  for (; group != 0; group = robot.joints[group].parent) {
    const JointMotion& joint = robot.joints[group];
    const Pose pose = robot.worldFrom(group);
    const Eigen::Matrix3d world_from_parent = robot.worldFrom(joint.parent).linear();
    double* const change = &gradient[joint.variable];
    switch (joint.kind) {
      case JointKind::fixed:
        break;
      case JointKind::revolute:
        change[0] += joint.multiplier * turned(pose.linear() * joint.axis, pose.translation(), point, direction);
        break;
      case JointKind::prismatic:
        change[0] += joint.multiplier *
                     direction.dot(world_from_parent * Eigen::Vector3d(joint.slide[0], joint.slide[1], joint.slide[2]));
        break;
      case JointKind::planar: {
        const Eigen::Matrix3d plane = world_from_parent * joint.parent_from_plane.linear();
        change[0] += direction.dot(plane.col(0));
        change[1] += direction.dot(plane.col(1));
        change[2] += turned(plane.col(2), pose.translation(), point, direction);
        break;
      }
      case JointKind::floating:
        addFloating(robot, group, point, direction, gradient);
        break;
    }
  }
}

}  // namespace

void clearanceGradient(const Kinematics& kinematics, const RobotShapes& robot, const std::vector<FourPoses>& groups,
                       const std::vector<FourDoubles>& values, std::size_t lane, const StatePair& pair,
                       std::vector<double>& gradient) {
  gradient.assign(values.size(), 0.0);
  const Placed placed{kinematics.state().groups, groups, values, lane};
  for (const RobotBody& own : robot.bodies()) {
    if (own.body == pair.first) {
      addVelocity(placed, own.group, pair.proximity.on_first, -pair.proximity.normal, gradient);
    }
    if (own.body == pair.second) {
      addVelocity(placed, own.group, pair.proximity.on_second, pair.proximity.normal, gradient);
    }
  }
}

}  // namespace hgrid
