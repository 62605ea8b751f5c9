// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#include "bodies/forward_kinematics.h"

#include "geometry/sine_cosine.h"

namespace hgrid {
namespace {

/// Sets `world` to the product of two poses.
void compose(const FourPoses& parent, const FourPoses& in_parent, FourPoses& world) {
  for (std::size_t row = 0; row < 3; ++row) {
    const FourDoubles* const row_of_parent = parent.turn + 3 * row;
    for (std::size_t column = 0; column < 3; ++column) {
      world.turn[3 * row + column] = row_of_parent[0] * in_parent.turn[column] +
                                     row_of_parent[1] * in_parent.turn[3 + column] +
                                     row_of_parent[2] * in_parent.turn[6 + column];
    }
    world.shift[row] = row_of_parent[0] * in_parent.shift[0] + row_of_parent[1] * in_parent.shift[1] +
                       row_of_parent[2] * in_parent.shift[2] + parent.shift[row];
  }
}

/// Computes the pose of the group of a revolute joint, in the frame of the parent group.
void poseAtAngle(const JointMotion& joint, const FourDoubles& angle, FourPoses& in_parent) {
  const SineCosine turned = sineCosine(angle);
  const FourDoubles versine = fourDoubles(1.0) - turned.cosine;
  for (std::size_t i = 0; i < 9; ++i) {
    in_parent.turn[i] = fourDoubles(joint.turn[0][i]) + turned.sine * joint.turn[1][i] + versine * joint.turn[2][i];
  }
  for (std::size_t i = 0; i < 3; ++i) in_parent.shift[i] = fourDoubles(joint.shift[i]);
}

/// Computes the pose of the group of a prismatic joint.
void poseAtShift(const JointMotion& joint, const FourDoubles& position, FourPoses& in_parent) {
  for (std::size_t i = 0; i < 9; ++i) in_parent.turn[i] = fourDoubles(joint.turn[0][i]);
  for (std::size_t i = 0; i < 3; ++i) in_parent.shift[i] = fourDoubles(joint.shift[i]) + position * joint.slide[i];
}

/// Returns the pose that a planar joint gives its group, in the frame of the parent group.
Pose planarPose(const JointMotion& joint, double x, double y, double theta) {
  const SineCosine turned = sineCosine(fourDoubles(theta));
  const double sine = turned.sine[0], cosine = turned.cosine[0];
  Pose moved = Pose::Identity();
  moved.linear() << cosine, -sine, 0.0, sine, cosine, 0.0, 0.0, 0.0, 1.0;
  moved.translation() << x, y, 0.0;
  return joint.parent_from_plane * moved * joint.plane_from_child;
}

/// Computes the pose of the group of a planar or floating joint. Few robots have such joints, so this computes one
/// state at a time.
void poseOfFreeJoint(const JointMotion& joint, const FourDoubles* values, FourPoses& in_parent) {
  for (std::size_t lane = 0; lane < 4; ++lane) {
    const auto value = [&](std::size_t part) { return values[joint.variable + part][lane]; };
    if (joint.kind == JointKind::planar) {
      in_parent.set(lane, planarPose(joint, value(0), value(1), value(2)));
    } else {
      Pose moved = Pose::Identity();
      moved.translation() << value(0), value(1), value(2);
      moved.linear() = Eigen::Quaterniond(value(6), value(3), value(4), value(5)).normalized().toRotationMatrix();
      in_parent.set(lane, joint.parent_from_plane * moved);
    }
  }
}

/// Computes the pose that a joint gives its group, in the frame of the parent group.
void poseInParent(const JointMotion& joint, const std::vector<FourDoubles>& values, FourPoses& in_parent) {
  if (joint.kind == JointKind::planar || joint.kind == JointKind::floating) {
    return poseOfFreeJoint(joint, values.data(), in_parent);
  }
  const FourDoubles position = values[joint.variable] * joint.multiplier + fourDoubles(joint.offset);
  if (joint.kind == JointKind::revolute) {
    poseAtAngle(joint, position, in_parent);
  } else {
    poseAtShift(joint, position, in_parent);
  }
}

}  // namespace

void FourPoses::set(std::size_t lane, const Pose& pose) {
  for (Eigen::Index row = 0; row < 3; ++row) {
    for (Eigen::Index column = 0; column < 3; ++column) turn[3 * row + column].set(lane, pose.linear()(row, column));
    shift[row].set(lane, pose.translation()[row]);
  }
}

void forwardKinematics(const Kinematics& kinematics, const std::vector<FourDoubles>& values,
                       const Pose& world_from_root, const GroupChange* changes, GroupPoses& poses) {
  const std::vector<JointMotion>& joints = kinematics.state().groups;
  poses.in_parent.resize(joints.size());
  poses.in_world.resize(joints.size());
  for (std::size_t lane = 0; changes == nullptr && lane < 4; ++lane) poses.in_world[0].set(lane, world_from_root);
  for (std::size_t i = 1; i < joints.size(); ++i) {
    const GroupChange change = changeOf(changes, i);
    if (change == GroupChange::none) continue;
    if (change == GroupChange::joint) poseInParent(joints[i], values, poses.in_parent[i]);
    compose(poses.in_world[joints[i].parent], poses.in_parent[i], poses.in_world[i]);
  }
}

}  // namespace hgrid
