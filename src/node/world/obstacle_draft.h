// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <unordered_set>
#include <vector>

#include "hgrid_proximity/pairs/pair_rule.h"
#include "node/params/params.h"
#include "node/world/movers.h"
#include "node/world/obstacle_edits.h"

namespace hgrid {

/// Edits of obstacles, and what they change in the movers and in the rules. Any thread may make one.
struct ObstacleDraft {
  ObstacleEdits edits;                      ///< the edits, as editsOf() returns them
  std::unordered_set<std::string> leaving;  ///< full names of the obstacles whose movers leave
  NewMovers coming;                         ///< movers of the obstacles that are new or replaced
  std::vector<PairRule> touch;              ///< the rules for what may touch attached obstacles, after the edits
  Time first_end = Time::max();             ///< the earliest end of a lifetime among the edited obstacles
  std::vector<std::string> outdated;        ///< full names of the present obstacles that leave or change
  /// The obstacles in `outdated` as they were, once the draft was carried out. It takes long to destroy many of them.
  PlacedObstacles retired = {};
};

/// Returns what the edits change. If the body of an obstacle does not change, its mover stays. If only the pose of a
/// fixed obstacle changes, the scene keeps the body and its pairs.
/// @param present        the obstacles before the edits
/// @param some_attached  false only if no present obstacle is attached
/// @throws Refusal limit (~limits/max_rules)
ObstacleDraft draftOf(ObstacleEdits edits, const PlacedObstacles& present, bool some_attached, const Params& params,
                      const std::string& world_frame);

/// Lets the lifetimes of the edited obstacles begin at `now` [ROS time].
void beginLifetimes(ObstacleDraft& draft, Time now) noexcept;

/// A draft that was made before the tick, and the state of the world for which it was made.
struct PreparedObstacles {
  std::uint64_t revision = 0;                  ///< SharedObstacles::View::revision
  std::shared_ptr<const RobotEntries> robots;  ///< Tick::robots
  std::string world_frame;                     ///< Tick::world_frame
  ObstacleDraft draft;                         ///< its new movers hold the prepared bodies
};

}  // namespace hgrid
