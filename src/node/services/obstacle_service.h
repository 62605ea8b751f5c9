// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

#include <hgrid_proximity/ApplyObstacles.h>

#include <memory>

#include "hgrid_proximity/adapters/mesh.h"
#include "hgrid_proximity/narrow/narrow_phase.h"
#include "node/params/params.h"
#include "node/services/envelope/service_envelope.h"
#include "node/tick/change_world.h"

namespace hgrid {

/// Serves ~apply_obstacles. The thread that serves a request prepares the obstacles and the new structure; a tick only
/// takes them over.
class ObstacleService {
 public:
  /// `envelope` and `params` must outlive this object.
  /// @param meshes  settings for reading the mesh files of obstacles
  ObstacleService(ServiceEnvelope& envelope, const Params& params, std::shared_ptr<NarrowPhase> narrow_phase,
                  MeshPolicy meshes, PrepareObstacles prepare, ChangeWorld change_world,
                  WaitUntilStored wait_until_stored);

 private:
  void apply(ServiceCall<msg::ApplyObstacles>& call) const;

  const Params& params_;
  std::shared_ptr<NarrowPhase> narrow_phase_;
  MeshPolicy meshes_;
  PrepareObstacles prepare_;
  ChangeWorld change_world_;
  WaitUntilStored wait_until_stored_;
  ros::ServiceServer server_;
};

}  // namespace hgrid
