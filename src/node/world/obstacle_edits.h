// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

#include <map>
#include <set>
#include <string>

#include "node/sources/obstacle_change.h"
#include "node/world/placed_obstacle.h"

namespace hgrid {

/// Obstacles by full name.
using PlacedObstacles = std::map<std::string, PlacedObstacle>;

/// How the obstacles of the world change. No name is in both members.
struct ObstacleEdits {
  PlacedObstacles set;            ///< those that are added, replaced or moved, as they will be
  std::set<std::string> removed;  ///< names of those that are removed, also of some that are not there
};

/// Computes what a request changes. Neither the obstacles nor the world change.
/// @throws ChangeRefusal dup_id, unknown_id, conflict, or for a frame that is not known at the requested time
/// @throws Refusal conflict if ObstacleChanges::without_groups is set and obstacles of a group would not move together
ObstacleEdits editsOf(const ObstacleChanges& changes, const PlacedObstacles& present, const Surroundings& around);

}  // namespace hgrid
