// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

#include <cstddef>
#include <memory>
#include <string>
#include <vector>

#include "node/robots/robot_source.h"
#include "node/robots/robot_spec.h"

namespace hgrid {

/// What a change does to a robot.
enum class RobotOperation { add, remove, declare_absent, declare_present };

/// One change of one robot, as it was requested.
struct RobotRequest {
  RobotOperation operation = RobotOperation::add;
  std::size_t index = 0;  ///< of the change in the request
  RobotSpec spec;         ///< its name; for add, also its frames and, if `like` is empty, its description
  std::string like;       ///< for add: name of the robot that it is equal to
};

/// One change of one robot, ready for a tick.
struct RobotChange {
  RobotOperation operation = RobotOperation::add;
  std::size_t index = 0;  ///< of the change in the request
  std::string name;
  std::shared_ptr<const RobotSpec> spec;  ///< for add
  /// For add: the robot. For declare_present: the robot, if it was not loaded before; null: it still cannot be loaded.
  std::shared_ptr<const LoadedRobot> model;
};

/// Changes that are applied together or not at all, in this order.
using RobotChanges = std::vector<RobotChange>;

}  // namespace hgrid
