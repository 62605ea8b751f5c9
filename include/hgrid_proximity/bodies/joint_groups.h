// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "hgrid_proximity/bodies/robot_model.h"

namespace hgrid {

/// A group of joints, as the tag `<group>` of an SRDF describes it. Everything is given by name.
struct JointGroup {
  /// All joints on the way from one link to another.
  struct Chain {
    std::string base;  ///< name of the link at one end
    std::string tip;   ///< name of the link at the other end
  };
  std::string name;                 ///< name of the group
  std::vector<std::string> joints;  ///< joints, also virtual ones
  std::vector<std::string> links;   ///< links; each stands for the joint to its parent
  std::vector<Chain> chains;        ///< chains of links
  std::vector<std::string> groups;  ///< groups whose joints belong to this group, too
};

/// How the root link of a robot may move in the world, as the tag `<virtual_joint>` of an SRDF says.
struct VirtualJoint {
  std::string name;                   ///< name of the joint
  JointKind kind = JointKind::fixed;  ///< fixed, planar or floating
  std::string parent_frame;           ///< the frame in which the link moves
  std::string child_link;             ///< name of the link that it moves: the root link
};

/// What an SRDF says about the joints of a robot.
struct JointGroups {
  std::vector<JointGroup> groups;            ///< the groups, in the order of the SRDF
  std::vector<VirtualJoint> virtual_joints;  ///< the virtual joints, in the order of the SRDF

  /// Returns the virtual joint of this name, or null.
  const VirtualJoint* findVirtual(const std::string& name) const;
};

/// Returns the names of the variables (see JointVariable) that the joints of a group have, in the order of
/// Kinematics::variables(). Fixed joints and joints that mimic others have none. nullopt: a virtual joint of the group
/// moves the whole robot.
/// @throws Refusal unknown_id if there is no group of this name, or if it names a joint, link or group that does not
/// exist
/// @throws Refusal unsupported if no joint of the group can move
std::optional<std::vector<std::string>> variablesOf(const std::string& group, const JointGroups& groups,
                                                    const RobotModel& model);

}  // namespace hgrid
