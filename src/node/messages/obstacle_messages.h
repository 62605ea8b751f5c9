// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

#include <hgrid_proximity/ApplyObstacles.h>

#include <string>

#include "hgrid_proximity/adapters/urdf.h"
#include "hgrid_proximity/narrow/narrow_phase.h"
#include "node/params/params.h"
#include "node/sources/obstacle_change.h"

namespace hgrid {

/// Reads one change of a request of ~apply_obstacles.
/// @throws Refusal if the change is not valid; see also obstacleChangesOf()
ObstacleChange obstacleChangeOf(const ::hgrid_proximity::Obstacle& change, const std::string& caller,
                                const Params& params, NarrowPhase& narrow_phase, const MeshSource& meshes);

/// Reads a request of ~apply_obstacles. It prepares the shapes for exact distances, which may take long.
/// @param caller  name of the node that sent the request; owner of the added obstacles and of the complete set that
/// name none
/// @param meshes  reads the mesh files that the shapes name
/// @throws ChangeRefusal if a change is not valid; Refusal if the request is not. Nothing is compared with the world.
ObstacleChanges obstacleChangesOf(const ::hgrid_proximity::ApplyObstacles::Request& request, const std::string& caller,
                                  const Params& params, NarrowPhase& narrow_phase, const MeshSource& meshes);

}  // namespace hgrid
