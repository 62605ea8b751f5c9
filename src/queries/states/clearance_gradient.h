// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

#include "hgrid_proximity/queries/state_pair.h"
#include "queries/states/robot_in_state.h"

namespace hgrid {

/// Computes how the distance of two shapes changes with each variable of a robot [m/rad, or 1 for lengths].
///
/// To first order, the nearest points move with their bodies, and the distance changes by the difference of their
/// velocities along the normal. At states where the nearest points jump, for example between two corners, this is the
/// gradient of one of the sides.
/// @param groups  poses of the rigid groups in four states
/// @param values  value of each variable in four states
/// @param pair    the shapes; they must be apart, and their points known
/// @param gradient  receives one number for each variable
void clearanceGradient(const Kinematics& kinematics, const RobotShapes& robot, const std::vector<FourPoses>& groups,
                       const std::vector<FourDoubles>& values, std::size_t lane, const StatePair& pair,
                       std::vector<double>& gradient);

}  // namespace hgrid
