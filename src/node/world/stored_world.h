// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

#include <map>
#include <memory>
#include <set>
#include <string>
#include <vector>

#include "hgrid_proximity/pairs/pair_rule.h"
#include "node/robots/robot_entry.h"
#include "node/sources/loaded_map.h"
#include "node/world/placed_obstacle.h"

namespace hgrid {

/// What an earlier run of the node stored: everything that services and messages changed.
struct StoredWorld {
  std::vector<PlacedObstacle> obstacles;  ///< those that were added or changed
  std::set<std::string> removed;          ///< full names of the obstacles of ~obstacles that were removed
  std::vector<PairRule> rules;            ///< those of ~set_allowed
  StoredRobots robots;                    ///< those that were added, removed or declared absent
  /// Descriptions that came with requests, by the key of their item.
  std::map<std::string, std::shared_ptr<const RobotDescription>> descriptions;
  StoredMaps maps;                      ///< those that services loaded or removed
  std::vector<std::string> troubles;    ///< what could not be read, one sentence each
  std::vector<std::string> unreadable;  ///< keys of the items that could not be read
};

}  // namespace hgrid
