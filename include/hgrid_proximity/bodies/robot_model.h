// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "hgrid_proximity/bodies/body.h"
#include "hgrid_proximity/refusal.h"

namespace hgrid {

/// How a joint lets a link move relative to its parent link.
enum class JointKind : std::uint8_t { fixed, revolute, prismatic, planar, floating };

/// One link of a robot, with the joint that connects it to its parent link.
struct RobotLink {
  std::string name;                                 ///< name of the link in the URDF
  int parent = -1;                                  ///< index of the parent link; -1 for the root
  std::string joint;                                ///< name of the joint to the parent; empty for the root
  JointKind joint_kind = JointKind::fixed;          ///< kind of the joint to the parent; fixed for the root
  Pose parent_from_joint = Pose::Identity();        ///< pose of the link in its parent at joint position 0
  Eigen::Vector3d axis = Eigen::Vector3d::UnitX();  ///< axis of the joint, a unit vector in the link's frame
  bool has_axis = true;                             ///< false: the URDF gives an axis without length, so none is known
  double max_velocity = 0.0;                        ///< [rad/s] or [m/s] limit of the joint; 0: the URDF gives none
  double lower = 0.0;                               ///< [rad] or [m] lower joint limit; both limits 0: no limits
  double upper = 0.0;                               ///< [rad] or [m] upper joint limit
  bool continuous = false;                          ///< whether the joint turns without limits, whatever `lower` says
  std::string mimic;                                ///< name of the joint that this joint follows; empty: none
  double mimic_multiplier = 1.0;                    ///< its position is mimic_multiplier * position of `mimic` ...
  double mimic_offset = 0.0;                        ///< [rad] or [m] ... + mimic_offset
  bool has_collision = false;                       ///< whether the URDF has a `<collision>` for this link
  bool uses_visual = false;                         ///< whether `<visual>` gives the shapes instead of `<collision>`
  std::vector<BodyShape> shapes;                    ///< the shapes that could be read
  std::vector<Refusal> unreadable;                  ///< why the other shapes could not be read, one per shape
  std::uint32_t rigid_group = 0;                    ///< index of the link's rigid group in RobotModel::group_roots
  Pose group_from_link = Pose::Identity();          ///< pose of the link in the frame of the first link of its group

  /// Whether the URDF gives the link any shape that counts, even if the shape could not be read.
  bool hasGeometry() const { return has_collision || uses_visual; }
};

/// A robot as its URDF describes it. In `links`, parents come before their children.
struct RobotModel {
  std::string name;                        ///< name of the robot in the URDF
  std::vector<RobotLink> links;            ///< the links; parents come before their children
  std::vector<std::uint32_t> group_roots;  ///< index of the first link of each rigid group
  std::vector<std::string> warnings;       ///< sentences about odd input that was accepted

  /// Returns the index of the link with this name, or -1.
  int find(const std::string& link) const;
};

/// Sets `rigid_group`, `group_from_link` and `group_roots`. Links that fixed joints connect form one group.
void findRigidGroups(RobotModel& model);

/// Returns an upper bound [m] of the distance from the origin of a body to the points of its shapes.
double reachOf(const std::vector<BodyShape>& shapes);

/// How fast points that move with a link can be in the root frame, by the velocity limits of the joints above the link.
struct LinkSpeed {
  double limited = 0.0;  ///< [m/s] upper bound of the speed that the joints with limits give them
  bool is_bound = true;  ///< whether `limited` is an upper bound of their speed: no joint may add to it
};

/// Returns the speed of all points that move with a link and are at most `reach` [m] from its origin. 0 if the reach is
/// 0: then there are no points.
///
/// Every moving joint between the root and the link adds to the speed. A prismatic joint adds its velocity limit. A
/// revolute joint adds its velocity limit times the largest possible distance of the points from the joint. A joint
/// that mimics another one moves as far and as fast as that one allows, whatever its own limits say: publishers of
/// joint states and of tf do not obey them. A joint without a velocity limit adds nothing, and `is_bound` is false. The
/// same holds for a joint that is planar or floating, or mimics a joint that the model does not have, or over more than
/// eight others. `is_bound` is also false if a joint turns a slide that has no end.
LinkSpeed linkSpeed(const RobotModel& model, std::uint32_t link, double reach);

/// Returns an upper bound [m/s] of the speed that linkSpeed() is about. Infinite if there is none.
double speedBound(const RobotModel& model, std::uint32_t link, double reach);
/// As above, for the shapes of the link.
double speedBound(const RobotModel& model, std::uint32_t link);

/// Returns a link as a body "robot/link" of a scene, in the tf frame of its name. It is not covered if one of its
/// shapes could not be read; then no query and no state near it is CLEAR.
/// @param robot  name of the robot in the scene
/// @param links  which pairs of links may touch
Body linkBody(const RobotModel& model, std::uint32_t link, const std::string& robot,
              std::shared_ptr<const LinkMatrix> links);

}  // namespace hgrid
