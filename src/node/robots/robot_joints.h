// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

#include <optional>
#include <string>

#include "hgrid_proximity/adapters/urdf.h"
#include "hgrid_proximity/bodies/joint_groups.h"
#include "hgrid_proximity/bodies/kinematics.h"

namespace hgrid {

/// The joints of a robot, as its URDF and SRDF describe them.
struct RobotJoints {
  std::optional<Kinematics> kinematics;  ///< nullopt: `flaw` says why nobody can ask about states of the robot
  std::string flaw;
  JointGroups groups;      ///< empty if the SRDF has none, or if they cannot be used
  std::string group_flaw;  ///< why they cannot be used; empty: they can

  /// @param srdf  null: the robot has none
  RobotJoints(const RobotModel& model, const std::string* srdf, const DescriptionLimits& limits);
};

}  // namespace hgrid
