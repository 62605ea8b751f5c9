// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

#include <functional>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "hgrid_proximity/pairs/pair_rule.h"

namespace hgrid {

class World;
struct ObstacleChanges;
struct PreparedObstacles;
struct PreparedRobotBodies;
struct RobotEntry;
struct Tick;

/// Changes the world at the beginning of a tick, waits until that tick, ~bodies and ~rules are published, and returns
/// that tick.
/// @throws whatever the change throws; Refusal busy if no tick makes the change in time
using ChangeWorld = std::function<std::shared_ptr<const Tick>(const std::function<void(World&)>& change)>;

/// Prepares World::applyObstacles() on the calling thread, before the tick, for the current ROS time.
/// @param rules  the rules that World::setRules() will set together with the changes; null: the rules stay
/// @returns null if there is no world yet, or if the changes would be refused now
using PrepareObstacles = std::function<std::shared_ptr<PreparedObstacles>(const ObstacleChanges& changes,
                                                                          const std::vector<PairRule>* rules)>;

/// Prepares World::setRobot() or World::applyRobots() on the calling thread, before the tick.
/// @param edit  makes the same change to its argument, the robots of the newest tick; it may throw Refusal
/// @returns null if there is no world yet, or if the change would be refused now
using PrepareRobots = std::function<std::shared_ptr<PreparedRobotBodies>(
    const std::function<void(std::map<std::string, RobotEntry>&)>& edit)>;

/// Waits until the changes of the world are on disk, if ~state_folder is set. @returns whether they are
using WaitUntilStored = std::function<bool()>;

}  // namespace hgrid
