// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "hgrid_proximity/narrow/narrow_phase.h"
#include "hgrid_proximity/pairs/rule_book.h"
#include "hgrid_proximity/world/scene.h"
#include "node/diagnostics/ledger.h"
#include "node/params/params.h"
#include "node/sources/loaded_map.h"
#include "node/sources/robot_source.h"
#include "node/sources/source_id.h"
#include "node/tf/tf_intake.h"
#include "node/tick/tick.h"
#include "node/time/clock_watch.h"
#include "node/world/cloud_bodies.h"
#include "node/world/map_bodies.h"
#include "node/world/missing_sources.h"
#include "node/world/mover_poses.h"
#include "node/world/movers.h"
#include "node/world/obstacle_bodies.h"
#include "node/world/robot_models.h"
#include "node/world/rules_in_force.h"

namespace hgrid {

/// Makes the ticks: each brings the Scene up to date with the transforms and the sources, then takes a snapshot.
///
/// The parts of this class do the work. This class says in which order a change or a tick goes through them. One thread
/// writes; any thread may read a Tick.
///
/// A call that throws, also for lack of memory, has changed nothing. tick() may throw for lack of memory; the next tick
/// is right.
class World {
 public:
  /// @param simulated  /clock drives ROS time
  World(const Params& params, bool simulated, std::uint64_t epoch, Ledger& ledger,
        std::shared_ptr<NarrowPhase> narrow_phase);
  World(const World&) = delete;
  World& operator=(const World&) = delete;

  TfIntake& transforms() { return transforms_; }
  const TfIntake& transforms() const { return transforms_; }

  /// Replaces the robot of the same name, if there is one.
  /// @throws Refusal limit (~max_bodies), or as Scene::exchange()
  void setRobot(LoadedRobot robot);
  /// Replaces the map of the same name, if there is one.
  /// @throws Refusal not_ready (no world frame yet), limit, bad_geometry (no cells), unknown_frame (the pose of the old
  /// map is known, that of the new one is not)
  void setMap(const LoadedMap& map);
  /// Removes a map, or no longer waits for it. An empty name means all maps.
  /// @throws Refusal unknown_id
  void clearMap(const std::string& name);
  /// Replaces what a sensor has seen before by what it has seen lately.
  /// @throws Refusal limit
  void setCloud(const LoadedCloud& cloud);
  /// Says why a source is not in the world yet, or why its newest data could not be used. What is in the world stays.
  void setMissing(const SourceId& source, const std::string& sentence);
  /// Replaces all rules of the allowed-pair matrix, from the next tick on. Rules expire by themselves.
  void setRules(std::vector<PairRule> rules);
  /// Restores the configured obstacles, sets the counters to 0 and begins a new epoch. Rules stay.
  void reset();

  std::shared_ptr<const Tick> tick(const Moment& now);

 private:
  void handleClock(const Moment& now);
  void beginEpoch();
  bool findWorldFrame();
  std::vector<SourceGap> listMissing(const Moment& now, Tick& tick) const;

  const Params& params_;
  Ledger& ledger_;
  Scene scene_;
  TfIntake transforms_;
  ClockWatch clock_;
  Movers movers_;
  MoverPoses poses_;
  RobotModels robots_;
  ObstacleBodies obstacles_;
  MapBodies maps_;
  CloudBodies clouds_;
  MissingSources missing_;
  RulesInForce rules_;
  std::string world_frame_;
  std::uint64_t epoch_;
};

}  // namespace hgrid
