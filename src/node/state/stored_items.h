// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

#include <chrono>
#include <optional>
#include <string>
#include <vector>

#include "hgrid_proximity/narrow/narrow_phase.h"
#include "node/state/state_edit.h"
#include "node/world/stored_world.h"

namespace hgrid {

/// The present time of the two clocks that the end of a rule needs: rules end by the steady clock, which begins again
/// when the computer is started. So their ends are stored by the wall clock.
struct RuleClocks {
  PairRule::Clock::time_point steady;
  std::chrono::system_clock::time_point wall;
  static RuleClocks now() { return {PairRule::Clock::now(), std::chrono::system_clock::now()}; }
};

/// The keys of all obstacles begin with the first of these, those of all maps with the second, and so on. All rules
/// together have one key.
inline constexpr const char* kObstacleKeys = "obstacle ";
inline constexpr const char* kMapKeys = "map ";
inline constexpr const char* kRobotKeys = "robot ";
inline constexpr const char* kDescriptionKeys = "description ";
inline constexpr const char* kRulesKey = "rules";

/// Returns the key of a description. Equal texts have the same key, so they are stored once.
std::string keyOf(const RobotDescription& text);

///@{
/// Returns the edit that stores the value.
StateEdit editOf(const PlacedObstacle& obstacle);
/// @param is_configured  whether ~obstacles has an obstacle of this name, so that its removal must be stored
StateEdit removalOf(const std::string& obstacle, bool is_configured);
StateEdit editOf(const std::vector<PairRule>& rules, const RuleClocks& clocks);
/// @param map  nullopt: the map was removed
StateEdit editOf(const std::string& name, const std::optional<MapParams>& map);
/// The text of the description is an item of its own, because equal robots share it.
/// @param robot  nullopt: the robot was removed
StateEdit editOfRobot(const std::string& name, const std::optional<StoredRobot>& robot);
StateEdit editOf(const RobotDescription& text);
///@}
/// Returns the edit that removes what editOf(text) stored.
StateEdit removalOf(const RobotDescription& text);
/// Returns the edit that stores nothing about a robot, because it is as ~robots says.
StateEdit removalOfRobot(const std::string& name);

/// Reads all items. An item that cannot be read becomes a trouble.
StoredWorld storedWorldOf(const StateItems& items, NarrowPhase& narrow_phase, const RuleClocks& clocks);

}  // namespace hgrid
