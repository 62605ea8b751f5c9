// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#include "node/robots/robot_joints.h"

#include "hgrid_proximity/adapters/srdf.h"

namespace hgrid {

RobotJoints::RobotJoints(const RobotModel& model, const std::string* srdf, const DescriptionLimits& limits) {
  try {
    kinematics.emplace(model);
  } catch (const Refusal& refusal) {
    flaw = refusal.what();
  }
  try {
    if (srdf != nullptr) groups = readJointGroups(*srdf, limits);
  } catch (const Refusal& refusal) {
    group_flaw = refusal.what();
  }
}

}  // namespace hgrid
