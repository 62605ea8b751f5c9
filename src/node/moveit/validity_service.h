// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

#include <ros/node_handle.h>
#include <ros/service_server.h>

#include "node/health/commons.h"
#include "node/moveit/validity_types.h"
#include "node/services/envelope/service_envelope.h"
#include "node/tf/transform_lookup.h"
#include "node/tick/newest_tick.h"

namespace hgrid {

/// Serves check_state_validity from the newest tick, with the types of moveit_msgs of Noetic. The threads of the node
/// handle's callback queue serve it. No request waits for a tick.
class ValidityService {
 public:
  /// @param node  the name of the service is resolved in its namespace
  /// All other parameters must outlive this object.
  ValidityService(ros::NodeHandle node, Commons& commons, NewestTick newest, const TransformLookup& transforms);

 private:
  void answer(const moveit::GetStateValidity::Request& request, moveit::GetStateValidity::Response& response);

  Commons& commons_;
  NewestTick newest_;
  const TransformLookup& transforms_;
  ros::ServiceServer server_;
};

}  // namespace hgrid
