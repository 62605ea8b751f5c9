// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#include "bodies/forward_kinematics.h"

#include "geometry/sine_cosine.h"

namespace hgrid {
namespace {

/// Sets `result` to the product of two rotations.
void multiply(const FourDoubles (&a)[9], const FourDoubles (&b)[9], FourDoubles (&result)[9]) {
  for (std::size_t row = 0; row < 3; ++row) {
    for (std::size_t column = 0; column < 3; ++column) {
      result[3 * row + column] =
          a[3 * row] * b[column] + a[3 * row + 1] * b[3 + column] + a[3 * row + 2] * b[6 + column];
    }
  }
}

/// Sets `result` to a point of the parent group in the world.
void moveBy(const FourPoses& parent, const FourDoubles (&point)[3], FourDoubles (&result)[3]) {
  for (std::size_t row = 0; row < 3; ++row) {
    result[row] = parent.turn[3 * row] * point[0] + parent.turn[3 * row + 1] * point[1] +
                  parent.turn[3 * row + 2] * point[2] + parent.shift[row];
  }
}

void turnGroup(const JointMotion& joint, const FourDoubles& angle, const FourPoses& parent, FourPoses& group) {
  const SineCosine turned = sineCosine(angle);
  const FourDoubles versine = fourDoubles(1.0) - turned.cosine;
  FourDoubles turn[9], shift[3];
  for (std::size_t i = 0; i < 9; ++i) {
    turn[i] = fourDoubles(joint.turn[0][i]) + turned.sine * joint.turn[1][i] + versine * joint.turn[2][i];
  }
  for (std::size_t i = 0; i < 3; ++i) shift[i] = fourDoubles(joint.shift[i]);
  multiply(parent.turn, turn, group.turn);
  moveBy(parent, shift, group.shift);
}

void shiftGroup(const JointMotion& joint, const FourDoubles& position, const FourPoses& parent, FourPoses& group) {
  FourDoubles turn[9], shift[3];
  for (std::size_t i = 0; i < 9; ++i) turn[i] = fourDoubles(joint.turn[0][i]);
  for (std::size_t i = 0; i < 3; ++i) shift[i] = fourDoubles(joint.shift[i]) + position * joint.slide[i];
  multiply(parent.turn, turn, group.turn);
  moveBy(parent, shift, group.shift);
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

/// Moves the group of a planar or floating joint. Few robots have such joints, so this computes one state at a time.
void moveFreely(const JointMotion& joint, const FourDoubles* values, const FourPoses& parent, FourPoses& group) {
  for (std::size_t lane = 0; lane < 4; ++lane) {
    const auto value = [&](std::size_t part) { return values[joint.variable + part][lane]; };
    Pose parent_from_group = Pose::Identity();
    if (joint.kind == JointKind::planar) {
      parent_from_group = planarPose(joint, value(0), value(1), value(2));
    } else {
      Pose moved = Pose::Identity();
      moved.translation() << value(0), value(1), value(2);
      moved.linear() = Eigen::Quaterniond(value(6), value(3), value(4), value(5)).normalized().toRotationMatrix();
      parent_from_group = joint.parent_from_plane * moved;
    }
    group.set(lane, parent.of(lane) * parent_from_group);
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
                       const Pose& world_from_root, const std::uint8_t* changing, std::vector<FourPoses>& groups) {
  const std::vector<JointMotion>& joints = kinematics.state().groups;
  for (std::size_t lane = 0; changing == nullptr && lane < 4; ++lane) groups[0].set(lane, world_from_root);
  for (std::size_t i = 1; i < joints.size(); ++i) {
    if (changing != nullptr && changing[i] == 0) continue;
    const JointMotion& joint = joints[i];
    const FourPoses& parent = groups[joint.parent];
    if (joint.kind == JointKind::planar || joint.kind == JointKind::floating) {
      moveFreely(joint, values.data(), parent, groups[i]);
      continue;
    }
    const FourDoubles position = values[joint.variable] * joint.multiplier + fourDoubles(joint.offset);
    if (joint.kind == JointKind::revolute) {
      turnGroup(joint, position, parent, groups[i]);
    } else {
      shiftGroup(joint, position, parent, groups[i]);
    }
  }
}

}  // namespace hgrid
