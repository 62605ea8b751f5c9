// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

#include <hgrid_proximity/ListScenes.h>
#include <hgrid_proximity/LoadScene.h>
#include <hgrid_proximity/SaveScene.h>

#include <memory>
#include <vector>

#include "hgrid_proximity/narrow/narrow_phase.h"
#include "node/params/params.h"
#include "node/services/envelope/service_envelope.h"
#include "node/tick/change_world.h"

namespace hgrid {

/// Serves ~save_scene, ~load_scene and ~list_scenes. The thread that serves a request reads or writes the file, and
/// prepares what it reads. A tick only takes over the prepared obstacles and rules, or returns the present obstacles.
///
/// As with AllowedServices, only one thread may serve requests.
class SceneFileServices {
 public:
  /// `envelope` and `params` must outlive this object.
  SceneFileServices(ServiceEnvelope& envelope, const Params& params, std::shared_ptr<NarrowPhase> narrow_phase,
                    PrepareObstacles prepare, ChangeWorld change_world, WaitUntilStored wait_until_stored);

 private:
  void save(ServiceCall<msg::SaveScene>& call) const;
  void load(ServiceCall<msg::LoadScene>& call) const;
  void list(ServiceCall<msg::ListScenes>& call) const;

  const Params& params_;
  std::shared_ptr<NarrowPhase> narrow_phase_;
  PrepareObstacles prepare_;
  ChangeWorld change_world_;
  WaitUntilStored wait_until_stored_;
  std::vector<ros::ServiceServer> servers_;
};

}  // namespace hgrid
