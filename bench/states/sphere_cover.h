// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

#include <cstddef>

#include "hgrid_proximity/bodies/robot_model.h"

namespace hgrid {
namespace bench {

/// Replaces the meshes of each link by spheres that contain all of their triangles: six in a row along the longest side
/// of the link, or two if this side is shorter than 8 cm.
/// @returns the number of spheres of the robot
std::size_t coverBySpheres(RobotModel& model);

}  // namespace bench
}  // namespace hgrid
