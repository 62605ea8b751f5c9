// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "hgrid_proximity/narrow/narrow_phase.h"
#include "hgrid_proximity/pairs/rule_book.h"
#include "hgrid_proximity/world/scene.h"
#include "node/health/ledger.h"
#include "node/params/settings.h"
#include "node/robots/robot_change.h"
#include "node/robots/robot_source.h"
#include "node/sources/loaded_map.h"
#include "node/sources/source_id.h"
#include "node/tf/tf_intake.h"
#include "node/tick/tick.h"
#include "node/time/clock_watch.h"
#include "node/world/cloud_bodies.h"
#include "node/world/link_paddings.h"
#include "node/world/map_bodies.h"
#include "node/world/matrix_rules.h"
#include "node/world/missing_sources.h"
#include "node/world/mover_poses.h"
#include "node/world/movers.h"
#include "node/world/obstacle_bodies.h"
#include "node/world/robot_bodies.h"
#include "node/world/rules_in_force.h"
#include "node/world/track_bodies.h"

namespace hgrid {

/// Makes the ticks: each tick updates the Scene with the transforms and the sources, then takes a snapshot.
///
/// The members of this class do the work. The class itself only decides in which order a change or a tick uses them.
/// Only the tick thread may call its functions, except prepareRobots(), prepareObstacles() and the constant
/// transforms(). Any thread may read a Tick.
///
/// A call that throws, even because memory ran out, changes nothing. Only tick() may leave its work half done if memory
/// runs out; the next tick completes it.
class World {
 public:
  /// @param settings   never null; most of the parameters cannot change later, see setSettings()
  /// @param simulated  whether /clock drives ROS time
  /// @param epoch      number of the first epoch
  /// @param stored     what an earlier run of the node stored
  World(std::shared_ptr<const Settings> settings, bool simulated, std::uint64_t epoch, Ledger& ledger,
        std::shared_ptr<NarrowPhase> narrow_phase, const StoredWorld& stored = {});
  World(const World&) = delete;
  World& operator=(const World&) = delete;

  TfIntake& transforms() { return transforms_; }
  const TfIntake& transforms() const { return transforms_; }

  /// Replaces the model of a robot, or adds a robot. See RobotBodies::set().
  /// @param prepared  result of prepareRobots() for the same robot; null: none
  void setRobot(std::shared_ptr<const LoadedRobot> robot, PreparedRobotBodies* prepared = nullptr) {
    robots_.set(std::move(robot), prepared);
  }
  /// Applies changes of robots, all of them or none. See RobotBodies::apply().
  /// @param prepared  result of prepareRobots() for the same changes; null: none
  void applyRobots(const RobotChanges& changes, PreparedRobotBodies* prepared = nullptr);
  /// Prepares setRobot() or applyRobots(), so that the tick with the change takes less time. Any thread may call this.
  /// It takes long if there are many bodies. See PrepareRobots. @param newest  null: there is no tick yet
  std::shared_ptr<PreparedRobotBodies> prepareRobots(const std::function<void(RobotEntries&)>& edit,
                                                     const std::shared_ptr<const Tick>& newest) const;
  /// Returns the robots, also those that are absent or not loaded.
  const RobotModels& robots() const { return robots_.models(); }
  /// Replaces the map of the same name, if there is one.
  /// @throws Refusal not_ready (no world frame yet), limit, bad_geometry (no cells), or unknown_frame (the map would
  /// move to a frame that is not connected to the world frame)
  void setMap(const LoadedMap& map);
  /// Removes a map, or stops waiting for it. An empty name means all maps.
  /// @throws Refusal unknown_id if there is no such map
  void clearMap(const std::string& name);
  /// Replaces the cells of a cloud. The first call for a cloud adds the body of the cloud.
  /// @throws Refusal limit (~limits/max_bodies)
  void setCloud(const LoadedCloud& cloud);
  /// Replaces all tracks of a tracker. See TrackBodies::set().
  /// @param tracker  as TrackerParams::name
  void setTracks(const std::string& tracker, std::shared_ptr<const TrackSet> set);
  /// Notes which frames the messages of a cloud or a tracker refer to, so that there is room for their transforms.
  void setDataFrames(const SourceId& source, const std::vector<std::string>& frames);
  /// Stores why a source is not in the world yet, or why its newest data could not be used. Bodies in the world stay.
  void setMissing(const SourceId& source, const std::string& sentence);
  /// Ends what setMissing() began, because the source needs no newer data any more.
  void clearMissing(const SourceId& source) noexcept { missing_.erase(source); }
  /// Replaces all rules for allowed pairs, from the next tick on. Expired rules are removed automatically.
  void setRules(PreparedRules rules);
  /// Moves a result of matchNames() to Scene::prepareNames(). Does nothing if it is null.
  void prepareNames(const std::shared_ptr<NameMatches>& matches) {
    if (matches) scene_.prepareNames(std::move(*matches));
  }
  /// Replaces the parameters that may change while the node runs. The next tick is the first with all of them.
  /// @param settings  changedSettings() made it from the settings in force; never null
  void setSettings(std::shared_ptr<const Settings> settings);
  /// Applies changes of obstacles, all of them or none.
  /// @param now  current ROS time
  /// @param prepared  result of prepareObstacles() for these changes; null: none
  /// @throws Refusal not_ready (no world frame or no time yet), or as ObstacleBodies::apply()
  void applyObstacles(const ObstacleChanges& changes, Time now, PreparedObstacles* prepared = nullptr);
  /// Prepares applyObstacles(), so that the tick with the changes takes less time. Any thread may call this. It takes
  /// long if there are many bodies. Poses at present are those at `now`. See PrepareObstacles.
  /// @param newest  null: there is no tick yet
  std::shared_ptr<PreparedObstacles> prepareObstacles(const ObstacleChanges& changes,
                                                      const std::shared_ptr<const Tick>& newest, Time now,
                                                      const std::vector<PairRule>* rules = nullptr) const;
  /// Replaces the paddings of links that were set at run time, from the next tick on. They hold for robots that are
  /// loaded later, too. The larger one of this padding and that of ~padding counts.
  void setLinkPaddings(LinkPaddings paddings) noexcept { robots_.setPaddings(std::move(paddings)); }
  const LinkPaddings& linkPaddings() const { return robots_.paddings(); }
  /// Replaces the allowed collision matrix of MoveIt, from the next tick on. No rules: there is none.
  void setMatrix(std::vector<MatrixRule> matrix) noexcept { matrix_.set(std::move(matrix)); }
  const std::vector<MatrixRule>& matrix() const { return matrix_.matrix(); }
  /// Returns the obstacles in the world.
  const ObstacleBodies& obstacles() const { return obstacles_; }
  /// Ends what ObstacleBodies::unsaved() lists.
  void forgetUnsaved() noexcept { obstacles_.forgetUnsaved(); }
  /// Restores the configured robots and obstacles, sets all counters to 0 and begins a new epoch. Forgets what MoveIt
  /// set. Rules and settings stay. Robots that were removed must be loaded again.
  void reset();

  /// Makes the next tick, without Tick::history. @param now  current time of both clocks
  std::shared_ptr<Tick> tick(const Moment& now);

 private:
  void handleClock(const Moment& now);
  void beginEpoch();
  bool findWorldFrame();
  void needFrames(const Moment& now);
  std::vector<SourceGap> listMissing(const Moment& now, Tick& tick) const;

  const std::shared_ptr<const Settings> first_settings_;  // those of the start
  const Params& params_;                                  // of first_settings_; some of them may have changed since
  std::shared_ptr<const Settings> settings_;              // those in force
  Ledger& ledger_;
  Scene scene_;
  TfIntake transforms_;
  ClockWatch clock_;
  Movers movers_;
  MoverPoses poses_;
  MissingSources missing_;
  RobotBodies robots_;
  ObstacleBodies obstacles_;
  MapBodies maps_;
  CloudBodies clouds_;
  TrackBodies tracks_;
  RulesInForce rules_;
  MatrixRules matrix_;
  std::map<SourceId, std::vector<std::string>> data_frames_;  // by cloud or tracker
  /// Revisions of the movers and the models whose frames the transforms know; nullopt: not up to date.
  std::optional<std::pair<std::uint64_t, std::uint64_t>> needed_revision_;
  std::string world_frame_;
  std::uint64_t epoch_;
};

}  // namespace hgrid
