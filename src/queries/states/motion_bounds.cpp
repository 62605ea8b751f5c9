// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#include "queries/states/motion_bounds.h"

#include <algorithm>
#include <cmath>

#include "geometry/arc_tangent.h"

namespace hgrid {
namespace {

constexpr double kBoxRounding = 1.0 + 1e-5;  // the boxes of the shapes are in floats
// Bound of the rounding errors that one joint adds to the place of a point, relative to the reach of the robot and to
// the angle of the joint [rad] plus 1.
constexpr double kJointRounding = 4e-15;

/// Returns the distance of a point from an axis through the origin.
double distanceFromAxis(const Eigen::Vector3d& point, const Eigen::Vector3d& axis) {
  return (point - axis * axis.dot(point)).norm();
}

Eigen::Vector3d shiftOf(const JointMotion& joint) { return {joint.shift[0], joint.shift[1], joint.shift[2]}; }

/// Returns the corners of a box.
std::array<Eigen::Vector3d, 8> cornersOf(const TiltedBox<float>& box) {
  std::array<Eigen::Vector3d, 8> corners;
  for (int corner = 0; corner < 8; ++corner) {
    for (int k = 0; k < 3; ++k) {
      double at = box.center[k];
      for (int axis = 0; axis < 3; ++axis) {
        const double step = double{box.axes[axis][k]} * double{box.half[axis]};
        at += (corner >> axis & 1) != 0 ? step : -step;
      }
      corners[static_cast<std::size_t>(corner)][k] = at;
    }
  }
  return corners;
}

/// Rotates a vector of a rigid group to the world, in one of four states.
Eigen::Vector3d turnedBy(const FourPoses& pose, const Eigen::Vector3d& vector, std::size_t lane) {
  Eigen::Vector3d result;
  for (std::size_t row = 0; row < 3; ++row) {
    result[static_cast<Eigen::Index>(row)] = pose.turn[3 * row][lane] * vector[0] +
                                             pose.turn[3 * row + 1][lane] * vector[1] +
                                             pose.turn[3 * row + 2][lane] * vector[2];
  }
  return result;
}

/// Returns the angle between two unit quaternions, as rotations [rad].
double angleBetween(const Eigen::Vector4d& a, const Eigen::Vector4d& b) {
  const Eigen::Vector4d first = a.normalized(), second = b.normalized();
  const double difference = (first - second).norm(), sum = (first + second).norm();
  return 4.0 * arcTangent(std::min(difference, sum), std::max(difference, sum));
}

}  // namespace

MotionBounds::MotionBounds(const Kinematics& kinematics, const RobotShapes& robot)
    : kinematics_(kinematics), robot_(robot) {
  const std::vector<JointMotion>& joints = kinematics.state().groups;
  for (std::size_t i = 0; i < joints.size(); ++i) {
    const Eigen::Vector3d shift = shiftOf(joints[i]);
    const std::uint32_t depth = i == 0 ? 0 : groups_[joints[i].parent].depth + 1;
    groups_.push_back({depth, shift.norm(), distanceFromAxis(shift, joints[joints[i].parent].axis)});
    depths_ = std::max<std::size_t>(depths_, depth + 1);
  }
  for (const RobotShape& shape : robot.shapes()) {
    Extent extent{0.0, 0.0};
    for (const Eigen::Vector3d& corner : cornersOf(shape.in_group)) {
      extent.from_origin = std::max(extent.from_origin, corner.norm());
      extent.from_axis = std::max(extent.from_axis, distanceFromAxis(corner, joints[shape.group].axis));
    }
    extents_.push_back(extent);
  }
  for (const SelfPair& pair : robot.selfPairs()) {
    std::uint32_t a = robot.shapes()[pair.first].group, b = robot.shapes()[pair.second].group;
    while (a != b) (a > b ? a : b) = joints[std::max(a, b)].parent;  // parents have smaller numbers
    common_depth_.push_back(groups_[a].depth);
  }
}

float MotionBounds::find(const std::vector<FourDoubles>& from, const std::vector<FourDoubles>& to,
                         const std::vector<FourDoubles>& difference, std::size_t lane, Memory& memory) const {
  memory.joints.resize(groups_.size());
  memory.paths.resize(robot_.shapes().size() * depths_);
  memory.part_paths.resize(memory.paths.size());
  findTravels(from, difference, lane, memory.joints);
  double largest = 0.0, reach = 0.0;
  for (std::size_t i = 0; i < robot_.shapes().size(); ++i) {
    reach = std::max(reach, findPaths(i, memory.joints, &memory.paths[i * depths_]));
    if (i < robot_.counting()) largest = std::max(largest, memory.paths[i * depths_]);
  }
  for (std::size_t i = 0; i < robot_.selfPairs().size(); ++i) largest = std::max(largest, sumOf(i, memory.paths));
  const double angle = std::max(largestAngle(from, lane), largestAngle(to, lane));
  memory.rounding = kJointRounding * static_cast<double>(depths_) * reach * (1.0 + angle);
  return roundedUp(largest * kBoxRounding);
}

void MotionBounds::findPart(std::size_t shape, const HalfPart& part, Memory& memory) const {
  const std::vector<JointMotion>& motions = kinematics_.state().groups;
  const TiltedBox<Four>& box = part.placed[shape].box;
  Eigen::Vector3d center, half;
  for (std::size_t k = 0; k < 3; ++k) {
    const auto axis = static_cast<Eigen::Index>(k);
    center[axis] = double{box.center[k][part.lane]} + part.origin[axis];
    half[axis] = double{box.half[k][part.lane]};
  }
  const double radius = half.norm();
  double* const paths = &memory.part_paths[shape * depths_];
  std::uint32_t group = robot_.shapes()[shape].group;
  double from_origin = extents_[shape].from_origin, from_axis = extents_[shape].from_axis, path = 0.0;
  for (;; group = motions[group].parent) {
    const std::uint32_t depth = groups_[group].depth;
    paths[depth] = path;
    if (group == 0) return;
    const JointTravel& joint = memory.joints[group];
    const bool is_free = motions[group].kind == JointKind::floating;
    if (joint.turn > 0.0) {
      const FourPoses& pose = part.groups[group];
      Eigen::Vector3d way;  // from the axis of the joint to the middle of the shape
      for (std::size_t k = 0; k < 3; ++k) {
        way[static_cast<Eigen::Index>(k)] = center[static_cast<Eigen::Index>(k)] - pose.shift[k][part.lane];
      }
      if (!is_free) way = way.cross(turnedBy(pose, motions[group].axis, part.lane));
      const double lever = way.norm() + radius;
      path += part.length * joint.turn * std::min(lever, is_free ? from_origin : from_axis);
    }
    path += part.length * joint.slide;
    from_axis = groups_[group].from_axis + joint.most + from_origin;
    from_origin += groups_[group].from_parent + joint.most;
  }
}

float MotionBounds::reachOf(std::size_t shape, const Memory& memory) const {
  return roundedUp(memory.part_paths[shape * depths_] * kBoxRounding);
}

float MotionBounds::reachOfPair(std::size_t pair, const Memory& memory) const {
  return roundedUp(sumOf(pair, memory.part_paths) * kBoxRounding);
}

/// Adds the paths of two shapes in the frame of the deepest group that moves both.
double MotionBounds::sumOf(std::size_t pair, const std::vector<double>& paths) const {
  const SelfPair& shapes = robot_.selfPairs()[pair];
  const std::size_t depth = common_depth_[pair];
  return paths[shapes.first * depths_ + depth] + paths[shapes.second * depths_ + depth];
}

/// Returns the largest angle [rad] of a joint, or more.
double MotionBounds::largestAngle(const std::vector<FourDoubles>& values, std::size_t lane) const {
  double largest = 0.0;
  for (const JointMotion& joint : kinematics_.state().groups) {
    if (joint.kind == JointKind::revolute) {
      largest = std::max(largest, std::abs(joint.multiplier * values[joint.variable][lane]) + std::abs(joint.offset));
    } else if (joint.kind == JointKind::planar) {
      largest = std::max(largest, std::abs(values[joint.variable + 2][lane]));
    }
  }
  return largest;
}

void MotionBounds::findTravels(const std::vector<FourDoubles>& from, const std::vector<FourDoubles>& difference,
                               std::size_t lane, std::vector<JointTravel>& joints) const {
  const std::vector<JointMotion>& motions = kinematics_.state().groups;
  for (std::size_t i = 1; i < motions.size(); ++i) {
    const JointMotion& joint = motions[i];
    const auto first = [&](std::size_t part) { return from[joint.variable + part][lane]; };
    const auto change = [&](std::size_t part) { return difference[joint.variable + part][lane]; };
    JointTravel& travel = joints[i];
    travel = {};
    switch (joint.kind) {
      case JointKind::fixed:
        break;
      case JointKind::revolute:
        travel.turn = std::abs(joint.multiplier * change(0));
        break;
      case JointKind::prismatic: {
        const double begin = joint.multiplier * first(0) + joint.offset, way = joint.multiplier * change(0);
        travel.slide = std::abs(way);
        travel.most = std::max(std::abs(begin), std::abs(begin + way));
        break;
      }
      case JointKind::planar: {
        const Eigen::Vector2d begin(first(0), first(1)), way(change(0), change(1));
        travel.turn = std::abs(change(2));
        travel.slide = way.norm();
        travel.most = std::max(begin.norm(), (begin + way).norm());
        break;
      }
      case JointKind::floating: {
        const Eigen::Vector3d begin(first(0), first(1), first(2)), way(change(0), change(1), change(2));
        const Eigen::Vector4d turn(first(3), first(4), first(5), first(6));
        travel.turn = angleBetween(turn, turn + Eigen::Vector4d(change(3), change(4), change(5), change(6)));
        travel.slide = way.norm();
        travel.most = std::max(begin.norm(), (begin + way).norm());
        break;
      }
    }
  }
}

/// Computes the path of a shape in the frame of each group above it.
/// @param paths  by the depth of this group
/// @returns the largest distance of a point of the shape from the root on the edge [m]
double MotionBounds::findPaths(std::size_t shape, const std::vector<JointTravel>& joints, double* paths) const {
  const std::vector<JointMotion>& motions = kinematics_.state().groups;
  std::uint32_t group = robot_.shapes()[shape].group;
  double from_origin = extents_[shape].from_origin, from_axis = extents_[shape].from_axis, path = 0.0;
  for (;; group = motions[group].parent) {
    paths[groups_[group].depth] = path;
    if (group == 0) return from_origin;
    const JointTravel& joint = joints[group];
    path += joint.turn * (motions[group].kind == JointKind::floating ? from_origin : from_axis) + joint.slide;
    from_axis = groups_[group].from_axis + joint.most + from_origin;
    from_origin += groups_[group].from_parent + joint.most;
  }
}

}  // namespace hgrid
