// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "hgrid_proximity/bodies/body.h"
#include "hgrid_proximity/refusal.h"

namespace hgrid {

/// How a link's joint lets it move against its parent link.
enum class JointKind : std::uint8_t { fixed, revolute, prismatic, planar, floating };

/// One link of a robot with the joint that holds it.
struct RobotLink {
  std::string name;
  int parent = -1;    ///< index of the parent link; -1: the root
  std::string joint;  ///< name of the joint to the parent; empty for the root
  JointKind joint_kind = JointKind::fixed;
  Pose parent_from_joint = Pose::Identity();        ///< the link's pose in its parent at joint position 0
  Eigen::Vector3d axis = Eigen::Vector3d::UnitX();  ///< of the joint, unit vector in the link's frame
  double max_velocity = 0.0;                        ///< [rad/s] or [m/s]; 0: the description says none
  double lower = 0.0, upper = 0.0;                  ///< [rad] or [m]; both 0: no limits (continuous)
  bool has_collision = false;                       ///< its description has a <collision>
  bool uses_visual = false;                         ///< its shapes are those of <visual>, since it has no <collision>
  std::vector<BodyShape> shapes;                    ///< those that could be read
  std::vector<Refusal> unreadable;                  ///< those that could not, a sentence each
  std::uint32_t rigid_group = 0;                    ///< links with equal numbers move as one
  Pose group_from_link = Pose::Identity();          ///< the link's pose in the first link of its group

  /// Whether the description gives the link an extent, in shapes that could be read or not.
  bool hasGeometry() const { return has_collision || uses_visual; }
};

/// A robot as its description tells it: links, parents before children.
struct RobotModel {
  std::string name;
  std::vector<RobotLink> links;
  std::vector<std::uint32_t> group_roots;  ///< per rigid group: its first link
  std::vector<std::string> warnings;       ///< what is odd but was accepted

  /// Index of a link, or -1.
  int find(const std::string& link) const;
};

/// Fills rigid_group, group_from_link and group_roots from the joints: links joined by fixed joints form a group.
void findRigidGroups(RobotModel& model);

/// Bound of the speed of any point of the link's shapes in the root frame [m/s], from the joints' velocity
/// limits: each prismatic joint on the way adds its limit, each revolute one its limit times the longest
/// possible distance of the link's points from the joint. Infinite where a joint on the way has no limit.
double speedBound(const RobotModel& model, std::uint32_t link);

}  // namespace hgrid
