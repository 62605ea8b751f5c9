// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

#include <hgrid_proximity/ReloadRobot.h>

#include <functional>
#include <string>

#include "node/services/envelope/service_envelope.h"
#include "node/tick/change_world.h"

namespace hgrid {

/// Serves ~reload_robot, which reads the description of a robot again. The answer is sent after the first tick that
/// uses the new model.
class ReloadService {
 public:
  /// Loads the robot of this name again, or all robots if the name is empty.
  /// @returns Code::ok, or the reason of the last failure; a robot that could not be loaded keeps its old model
  using Reload = std::function<Refusal(const std::string& robot)>;

  /// @param envelope  must outlive this object
  ReloadService(ServiceEnvelope& envelope, Reload reload, ChangeWorld change_world);

 private:
  void reload(ServiceCall<msg::ReloadRobot>& call) const;

  Reload reload_;
  ChangeWorld change_world_;
  ros::ServiceServer server_;
};

}  // namespace hgrid
