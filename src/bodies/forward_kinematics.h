// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

#include <array>
#include <cmath>
#include <limits>
#include <vector>

#include "geometry/four_doubles.h"
#include "hgrid_proximity/bodies/kinematics.h"

namespace hgrid {

/// How a joint moves a rigid group. All values are in the frame of the parent group.
struct JointMotion {
  JointKind kind = JointKind::fixed;  // fixed: the root group, which does not move
  std::uint32_t parent = 0;           // index of the parent group, smaller than the index of this group
  std::uint32_t link = 0;             // index of the link that the joint moves
  std::uint32_t variable = 0;         // index of the first variable of the joint, or of the joint that it mimics
  bool mimics = false;
  double multiplier = 1.0, offset = 0.0;  // the position is multiplier * variable + offset
  double lower = -std::numeric_limits<double>::infinity(), upper = std::numeric_limits<double>::infinity();
  // The rotation is turn[0] + sin * turn[1] + (1 - cos) * turn[2] (Rodrigues' formula), in the order of rows.
  std::array<std::array<double, 9>, 3> turn{};
  std::array<double, 3> shift{}, slide{};     // the translation is shift + position * slide (only prismatic: slide)
  Pose parent_from_plane = Pose::Identity();  // planar and floating: the frame of x, y and theta
  Pose plane_from_child = Pose::Identity();   // planar: its rotation, inverted
  Eigen::Vector3d axis = Eigen::Vector3d::Zero();  // revolute and planar: unit vector of the axis of rotation

  /// Returns the number of variables of the joint.
  std::uint32_t variables() const { return kind == JointKind::planar ? 3 : kind == JointKind::floating ? 7 : 1; }
};

struct Kinematics::State {
  std::string name;
  std::vector<JointVariable> variables;
  std::vector<std::string> links;
  std::vector<std::uint32_t> group_of_link;
  std::vector<Pose> group_from_link;
  std::vector<JointMotion> groups;  // one for each rigid group, parents first
};

/// The poses of a rigid group in four states.
struct FourPoses {
  FourDoubles turn[9], shift[3];  // rotation matrix, in the order of rows; [m] translation

  /// Returns the pose in one of the states.
  Pose of(std::size_t lane) const {
    Pose pose = Pose::Identity();
    for (Eigen::Index row = 0; row < 3; ++row) {
      for (Eigen::Index column = 0; column < 3; ++column) {
        pose.linear()(row, column) = turn[3 * row + column][lane];
      }
      pose.translation()[row] = shift[row][lane];
    }
    return pose;
  }
  void set(std::size_t lane, const Pose& pose);
};

/// Why the pose of a rigid group must be computed again, if only some variables have changed.
enum class GroupChange : std::uint8_t {
  none,    ///< The pose is not computed again. It is the same, or nobody needs it; then it is that of an older state.
  parent,  ///< The position of its joint is the same, but the pose of the parent group has changed.
  joint    ///< The position of its joint has changed.
};

/// Returns the change of a group. @param changes  for each rigid group; null: all joints have changed
inline GroupChange changeOf(const GroupChange* changes, std::size_t group) {
  return changes == nullptr ? GroupChange::joint : changes[group];
}

/// The poses of all rigid groups in four states.
struct GroupPoses {
  std::vector<FourPoses> in_parent;  // of each group, in the frame of its parent group
  std::vector<FourPoses> in_world;
};

/// Computes the poses of all rigid groups in four states.
/// @param values           one value for each variable of `kinematics`
/// @param world_from_root  pose of the first rigid group
/// @param changes          for each rigid group; null: compute all
/// @param poses            receives the poses; if `changes` is not null, it must have the poses of an earlier call
void forwardKinematics(const Kinematics& kinematics, const std::vector<FourDoubles>& values,
                       const Pose& world_from_root, const GroupChange* changes, GroupPoses& poses);

}  // namespace hgrid
