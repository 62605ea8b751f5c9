// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include "node/tick/tick.h"
#include "node/wire/scene_types.h"
#include "node/world/matrix_rules.h"
#include "node/world/placed_obstacle.h"

namespace hgrid {

/// Converts the obstacles into a planning scene of MoveIt.
///
/// The scene contains all obstacles, whoever added them. Attached ones are in `robot_state`, in the frames of their
/// links; the others are in `collision_objects`, in the world frame. An obstacle that has no pose yet is left out. A
/// capsule becomes a cylinder and two spheres, because MoveIt has no capsules. Padding of obstacles is left out.
///
/// `link_padding` has the largest padding of the shapes of each link, from ~padding or from MoveIt. If several robots
/// have a link of this name, the name is "robot/link". `link_scale` is 1 for all of them.
/// @param components  bits of GetPlanningScene::Component: what the scene contains
/// @param obstacles   the obstacles, by full name, that `tick` contains
/// @param matrix      the newest allowed collision matrix of MoveIt
moveit::PlanningScene planningScene(std::uint32_t components, const Tick& tick,
                                    const std::map<std::string, PlacedObstacle>& obstacles,
                                    const std::vector<MatrixRule>& matrix);

}  // namespace hgrid
