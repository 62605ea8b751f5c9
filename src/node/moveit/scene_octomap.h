// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

#include "node/health/ledger.h"
#include "node/sources/map_source.h"
#include "node/tick/tick_jobs.h"
#include "node/wire/scene_types.h"

namespace hgrid {

class World;

/// Puts the octomaps of planning scenes into the world, as the map "map/planning_scene".
///
/// While the newest octomap is refused, the map is not complete. Any thread may use this object, except the tick
/// thread.
class SceneOctomap {
 public:
  /// All parameters must outlive this object.
  SceneOctomap(const MapSource& source, TickJobs& jobs, Ledger& ledger)
      : source_(source), jobs_(jobs), ledger_(ledger) {}

  /// Whether a planning scene says something about the octomap. If so and the octomap has no data, it removes the map.
  static bool isIn(const moveit::PlanningScene& scene) {
    return !scene.is_diff || !scene.octomap.id.empty() || !scene.octomap.data.empty();
  }

  /// Reads an octomap with data. @throws Refusal as MapSource
  LoadedMap read(const moveit::OctomapWithPose& octomap) const;
  /// Lets the next tick replace or remove the map. Counts and logs an octomap that is refused.
  void take(const moveit::OctomapWithPose& octomap);
  /// Counts, logs and reports that the newest octomap was refused.
  void refuse(const Refusal& why);
  /// Removes the map, if there is one. Only the tick thread may call this.
  static void clear(World& world);

 private:
  const MapSource& source_;
  TickJobs& jobs_;
  Ledger& ledger_;
};

}  // namespace hgrid
