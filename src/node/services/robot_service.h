// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

#include <hgrid_proximity/ApplyRobots.h>

#include "node/loading/robot_loader.h"
#include "node/params/params.h"
#include "node/services/envelope/service_envelope.h"
#include "node/tick/change_world.h"

namespace hgrid {

/// Serves ~apply_robots. The thread that serves a request reads the descriptions; a tick only changes the world.
class RobotService {
 public:
  /// `envelope`, `params` and `loader` must outlive this object. The thread that uses `loader` must serve the requests.
  RobotService(ServiceEnvelope& envelope, const Params& params, RobotLoader& loader, ChangeWorld change_world,
               WaitUntilStored wait_until_stored);

 private:
  void apply(ServiceCall<msg::ApplyRobots>& call) const;

  const Params& params_;
  RobotLoader& loader_;
  ChangeWorld change_world_;
  WaitUntilStored wait_until_stored_;
  ros::ServiceServer server_;
};

}  // namespace hgrid
