// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

#include <functional>
#include <memory>
#include <string>
#include <utility>

#include "hgrid_proximity/refusal.h"
#include "node/health/node_health.h"
#include "node/loading/description_watch.h"
#include "node/loading/pending_loads.h"
#include "node/loading/robot_changes.h"
#include "node/params/params.h"
#include "node/robots/robot_source.h"
#include "node/tick/change_world.h"
#include "node/tick/tick_jobs.h"
#include "node/world/robot_models.h"

namespace hgrid {

/// Puts robots into the world, and knows which of them are still to be loaded. Only one thread may use this object. The
/// tick thread must not use it.
class RobotLoader {
 public:
  /// `source`, `params`, `jobs` and `health` must outlive this object. @param robots  the robots of the world
  RobotLoader(const RobotSource& source, const Params& params, const RobotModels& robots, PrepareRobots prepare_bodies,
              TickJobs& jobs, NodeHealth& health);

  /// Returns the robots of the world after the last change that this object made.
  const RobotModels& robots() const { return robots_; }

  bool hasMissing() const { return !missing_.empty(); }
  /// Returns whether robots have become missing since the last call, so that they should be loaded at once.
  bool takeNewlyMissing() { return std::exchange(newly_missing_, false); }
  /// Tries to load every missing robot. Each failure is reported in the log, on ~status and on /diagnostics.
  void loadMissing();

  /// Loads the robot of this name again, or all robots if the name is empty. If a load fails, the old model stays.
  /// @returns ok; unknown_id if there is no such robot; otherwise the reason of the last failure
  Refusal reload(const std::string& name);

  /// Loads each robot whose description has changed. If a load fails, the old model of this robot stays, and the next
  /// loadMissing() tries again.
  void loadChanged();

  /// Prepares changes of robots. This is slow. @throws as hgrid::prepare()
  PreparedRobots prepare(const std::vector<RobotRequest>& requests) const;
  /// Makes a change of the world that may change robots. Loads of robots that are gone or absent are canceled.
  /// @param prepared  what was read for the change; null: nothing
  /// @throws whatever `change_world` throws
  std::shared_ptr<const Tick> change(const ChangeWorld& change_world, const std::function<void(World&)>& act,
                                     const PreparedRobots* prepared);
  /// Prepares the bodies of robots for World::applyRobots(). See PrepareRobots.
  std::shared_ptr<PreparedRobotBodies> prepareBodies(const RobotChanges& changes) const;

 private:
  using Robot = std::shared_ptr<const RobotSpec>;

  Refusal loadAgain(const Robot& robot, SharedReader& reader);
  Refusal load(const Robot& robot, SharedReader& reader);
  void noteFailed(const RobotSpec& robot, const Refusal& why);
  void adopt(const RobotModels& robots);

  const RobotSource& source_;
  const Params& params_;
  const PrepareRobots prepare_bodies_;
  TickJobs& jobs_;
  NodeHealth& health_;
  RobotModels robots_;  // as after the last change that this object made
  PendingLoads<Robot> missing_;
  bool newly_missing_ = false;
  DescriptionWatch watch_;
};

}  // namespace hgrid
