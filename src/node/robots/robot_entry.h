// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

#include <map>
#include <memory>
#include <optional>
#include <set>
#include <string>

#include "node/robots/robot_source.h"
#include "node/robots/robot_spec.h"

namespace hgrid {

/// A robot that is in the world, should be, or was declared absent.
struct RobotEntry {
  std::shared_ptr<const RobotSpec> spec;
  std::shared_ptr<const LoadedRobot> model;  ///< null: it is not loaded
  bool absent = false;                       ///< whether it was declared absent: it is no source, and has no bodies
  std::string refused;  ///< why its newest description could not be used, so that `model` is old; empty: it is not old

  bool inWorld() const { return model != nullptr && !absent; }
};

using RobotEntries = std::map<std::string, RobotEntry>;

/// Returns the model of the robot that has a link of this name, "robot/link"; null if no robot in the world has it.
const LoadedRobot* findLink(const RobotEntries& robots, const std::string& link);
/// Returns the frames of the links that planar and floating joints move, of all robots in the world.
std::set<std::string, std::less<>> freeFrames(const RobotEntries& robots);
/// Returns the full names, "robot/link", of the links of all robots in the world that have this name without the robot.
std::vector<std::string> linksNamed(const RobotEntries& robots, const std::string& name);

/// Returns the full names, "robot/link", of the links of all robots in the world whose tf frame this is.
std::vector<std::string> linksAt(const RobotEntries& robots, const std::string& frame);

/// A robot that an earlier run of the node added or declared absent.
struct StoredRobot {
  RobotSpec spec;
  bool absent = false;
};

/// What an earlier run of the node changed, by name of the robot; nullopt: the robot was removed.
using StoredRobots = std::map<std::string, std::optional<StoredRobot>>;

}  // namespace hgrid
