// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

#include <hgrid_proximity/ApplyRobots.h>

#include <vector>

#include "node/params/params.h"
#include "node/robots/robot_change.h"

namespace hgrid {

/// Reads a request of ~apply_robots: one RobotRequest for each name of each change, in their order.
/// @throws ChangeRefusal if a change is not valid; Refusal if the request is not. Nothing is compared with the world.
std::vector<RobotRequest> robotRequestsOf(const ::hgrid_proximity::ApplyRobots::Request& request, const Params& params);

}  // namespace hgrid
