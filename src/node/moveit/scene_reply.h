// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

#include <cstdint>
#include <map>
#include <string>

#include "node/moveit/scene_types.h"
#include "node/tick/tick.h"
#include "node/world/placed_obstacle.h"

namespace hgrid {

/// Converts the obstacles into a planning scene of MoveIt.
///
/// The scene contains all obstacles, whoever added them. Attached ones are in `robot_state`, in the frames of their
/// links; the others are in `collision_objects`, in the world frame. An obstacle that has no pose yet is left out. A
/// capsule becomes a cylinder and two spheres, because MoveIt has no capsules. Padding is left out.
/// @param components  bits of GetPlanningScene::Component: what the scene contains
/// @param obstacles   the obstacles, by full name, that `tick` contains
moveit::PlanningScene<moveit::Release::noetic> planningScene(std::uint32_t components, const Tick& tick,
                                                             const std::map<std::string, PlacedObstacle>& obstacles);

}  // namespace hgrid
