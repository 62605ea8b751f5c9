// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

#include <cstddef>
#include <cstdint>
#include <limits>
#include <memory>
#include <set>
#include <string>
#include <vector>

#include "hgrid_proximity/narrow/narrow_phase.h"
#include "node/health/ledger.h"
#include "node/params/params.h"
#include "node/sources/obstacle_change.h"
#include "node/tf/transform_lookup.h"
#include "node/tick/tick.h"
#include "node/world/missing_sources.h"
#include "node/world/movers.h"
#include "node/world/obstacle_draft.h"
#include "node/world/obstacle_edits.h"
#include "node/world/robot_models.h"
#include "node/world/rules_in_force.h"
#include "node/world/shared_obstacles.h"
#include "node/world/stored_world.h"

namespace hgrid {

/// The obstacles of the world: those of the parameters, and those of ~apply_obstacles.
///
/// A call that throws, even because memory ran out, changes nothing.
class ObstacleBodies {
 public:
  /// @param stored  what an earlier run of the node stored
  ObstacleBodies(const Params& params, std::shared_ptr<NarrowPhase> narrow_phase, StoredWorld stored, Ledger& ledger);

  /// Adds the configured and the stored obstacles that were not added yet. A refused obstacle becomes a missing source.
  /// If this throws, the next call continues with the obstacle that failed. Lifetimes begin at `now`.
  void addAll(const std::string& world_frame, Time now, Movers& movers, MissingSources& missing);
  /// Forgets all obstacles, also the stored ones, and makes the next addAll() begin with the first configured one. The
  /// bodies must have been removed from the movers.
  void startAgain(SharedObstacles::Spare spare) noexcept;

  /// Prepares apply(), so that it takes less time. Any thread may call this. It takes long if there are many bodies.
  /// @param now    current ROS time
  /// @param scene  the scene of the movers
  /// @param rules  see PrepareObstacles
  /// @returns null if there is no world yet, or if the changes would be refused now
  std::shared_ptr<PreparedObstacles> prepare(const ObstacleChanges& changes, const Tick& newest, Time now,
                                             const TransformLookup& lookup, const Scene& scene,
                                             const std::vector<PairRule>* rules) const;
  /// Applies changes, all of them or none.
  /// @param prepared  result of prepare() for the same changes, which may be out of date; null: none. If it is used, it
  ///                  then holds the obstacles that left or changed, which takes long to destroy.
  /// @throws ChangeRefusal or Refusal as editsOf(); Refusal limit (~limits/max_rules), or as Scene::exchange()
  void apply(const ObstacleChanges& changes, const Surroundings& around, Movers& movers,
             PreparedObstacles* prepared = nullptr);
  /// Finds the places of attached obstacles again, and the speeds of those that follow the frame of a link, if the
  /// model of a robot was replaced since the last call.
  void followRobots(const RobotModels& robots, const std::string& world_frame, Movers& movers);
  /// Removes the obstacles whose lifetime has ended.
  void expire(Time now, Movers& movers);
  /// Lets all lifetimes begin again, after ROS time jumped.
  void restamp(Time now);
  /// Returns the rules for what may touch the attached obstacles.
  const DerivedRules& touchRules() const { return touch_; }
  /// Returns the obstacles, by full name.
  const PlacedObstacles& all() const { return present_.all(); }
  /// Returns the obstacles, by full name. Any thread may call this. See SharedObstacles::view().
  std::shared_ptr<const PlacedObstacles> share() const { return present_.view().obstacles; }

  /// What changed since the last forgetUnsaved(), if ~state_folder is set.
  struct Unsaved {
    bool all_removed = false;     ///< whether startAgain() removed all obstacles, before the other changes
    std::set<std::string> names;  ///< obstacles that were added, changed or removed
  };
  const Unsaved& unsaved() const { return unsaved_; }
  void forgetUnsaved() noexcept;

 private:
  void addConfigured(const ObstacleParams& configured, const std::string& world_frame, Time now, Movers& movers);
  void addStored(const std::string& world_frame, Time now, Movers& movers, MissingSources& missing);
  std::set<std::string> unsavedAfter(const ObstacleEdits& edits) const;
  void carryOut(ObstacleEdits edits, const std::string& world_frame, Movers& movers);
  void carryOut(ObstacleDraft& draft, Movers& movers, const std::set<std::string>& lost = {});

  const Params& params_;
  std::shared_ptr<NarrowPhase> narrow_phase_;
  Ledger& ledger_;
  SharedObstacles present_;
  DerivedRules touch_;
  std::size_t done_ = 0;           // number of configured obstacles that were added or refused
  PlacedObstacles stored_;         // by an earlier run, and not added yet
  std::set<std::string> removed_;  // configured obstacles that an earlier run removed
  Unsaved unsaved_;
  static constexpr std::uint64_t kNoRevision = std::numeric_limits<std::uint64_t>::max();
  std::uint64_t robots_revision_ = 0;  // RobotModels::revision() in the last followRobots(), or kNoRevision
  Time first_end_ = Time::max();       // no lifetime ends before this time
};

}  // namespace hgrid
