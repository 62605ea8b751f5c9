// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

#include <ros/node_handle.h>

#include "node/health/commons.h"
#include "node/loading/loading.h"
#include "node/services/allowed_services.h"
#include "node/services/batch_service.h"
#include "node/services/explain_service.h"
#include "node/services/field_service.h"
#include "node/services/guard_service.h"
#include "node/services/map_services.h"
#include "node/services/obstacle_service.h"
#include "node/services/query_services.h"
#include "node/services/reload_service.h"
#include "node/services/reset_service.h"
#include "node/services/robot_service.h"
#include "node/services/scene_file_services.h"
#include "node/services/state_services.h"
#include "node/state/state_keeper.h"
#include "node/tf/transform_lookup.h"
#include "node/tick/leases.h"
#include "node/tick/newest_tick.h"
#include "node/tick/tick_history.h"

namespace hgrid {

/// Owns the services of the node. Any number of threads may serve queries and batches. One thread serves requests that
/// change the world or read and change the rules.
class NodeServices {
 public:
  /// @param quick_node  private node handle of a QuickCallbacks
  /// @param query_node  private node handle of the threads that serve queries
  /// @param batch_node  private node handle of the threads that serve requests with thousands of questions
  /// @param admin_node  private node handle of the thread that serves requests that change the world
  /// All other parameters must outlive this object.
  NodeServices(const ros::NodeHandle& quick_node, const ros::NodeHandle& query_node, const ros::NodeHandle& batch_node,
               const ros::NodeHandle& admin_node, Commons& commons, NewestTick newest,
               PrepareObstacles prepare_obstacles, ChangeWorld change_world, const TransformLookup& transforms,
               const TickHistory& history, Loading& loading, StateKeeper& state, Guard& guard, Stopwatch& stopwatch,
               QuerySketch& sketch);

  /// Drops the ticks of ended leases, and the checkers that no request has used for a second. Any thread may call this.
  /// @param epoch  the present epoch
  void dropUnused(std::uint64_t epoch) {
    leases_.dropEnded(epoch);
    states_.dropUnused();
  }

 private:
  ServiceEnvelope quick_questions_, questions_, batch_questions_, changes_;
  Leases leases_;
  QueryServices query_;
  BatchService batches_;
  FieldService fields_;
  StateServices states_;
  GuardService guard_;
  ExplainService explain_;
  AllowedServices allowed_;
  MapServices maps_;
  ObstacleService obstacles_;
  RobotService robots_;
  SceneFileServices scenes_;
  ResetService reset_;
  ReloadService reload_;
};

}  // namespace hgrid
