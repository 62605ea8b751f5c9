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

/// Edits of obstacles, and what they change in the movers and in the rules. Any thread may make a draft.
struct ObstacleDraft {
  ObstacleEdits edits;
  std::unordered_set<std::string> leaving;  ///< full names of the obstacles whose movers leave
  NewMovers coming;                         ///< movers of the obstacles that are new or replaced
  std::size_t coming_count = 0;             ///< number of these obstacles
  std::vector<PairRule> touch;              ///< the rules for what may touch attached obstacles, after the edits
  Time first_end = Time::max();             ///< the earliest end of a lifetime among the edited obstacles
  std::vector<std::string> outdated;        ///< full names of the present obstacles that leave or change
  /// After the draft was carried out: these obstacles as they were. It takes long to destroy many of them.
  PlacedObstacles retired = {};
};

/// If only the pose of a fixed obstacle changes, the scene keeps the body and its pairs.
/// @param present  the obstacles before the edits
/// @throws Refusal limit (~max_rules)
ObstacleDraft draftOf(ObstacleEdits edits, const PlacedObstacles& present, const Params& params,
                      const std::string& world_frame);

/// A draft that was made beside the ticks, and for what it was made.
struct PreparedObstacles {
  std::uint64_t revision = 0;                  ///< SharedObstacles::View::revision
  std::shared_ptr<const RobotEntries> robots;  ///< Tick::robots
  std::string world_frame;                     ///< Tick::world_frame
  ObstacleDraft draft;                         ///< with a scene that is prepared for it
};

}  // namespace hgrid
