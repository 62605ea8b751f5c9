// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

#include <string>
#include <vector>

#include "hgrid_proximity/bodies/kinematics.h"

namespace hgrid {
namespace bench {

/// A robot whose states are checked.
struct StateRobot {
  std::string name;                ///< for the table
  RobotModel model;                ///< its links, joints and shapes
  LinkRules rules;                 ///< the rules of its SRDF
  std::vector<std::string> group;  ///< the variables that differ between the states
};

/// Reads the Panda, the UR5, and the PR2 with its right arm as the group. The last robot is the Panda, with spheres
/// around its meshes (see coverBySpheres()). Their files are in the folder HGRID_TEST_DATA or, if that is not set, in
/// ../shared/data beside the project. Returns nothing if there are no such files, or if the libraries for reading URDFs
/// were not found.
std::vector<StateRobot> stateRobots();

}  // namespace bench
}  // namespace hgrid
