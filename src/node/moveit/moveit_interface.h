// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

#include <ros/node_handle.h>

#include <functional>
#include <optional>
#include <utility>

#include "node/health/commons.h"
#include "node/moveit/scene_services.h"
#include "node/moveit/scene_topics.h"
#include "node/moveit/validity_service.h"
#include "node/tick/newest_tick.h"

namespace hgrid {

/// Owns the topics and services that are those of MoveIt's move_group, as far as ~moveit/topics and ~moveit/services
/// ask for them.
class MoveItInterface {
 public:
  /// @param node       its thread serves the services that change or read the scene
  /// @param query_node  its threads serve the other services
  /// @param is_ending  returns whether the node is shutting down
  /// All other parameters must outlive this object.
  MoveItInterface(ros::NodeHandle node, const ros::NodeHandle& query_node, Commons& commons, const MapSource& maps,
                  TickJobs& jobs, const PrepareObstacles& prepare_obstacles, const ChangeWorld& change_world,
                  NewestTick newest, const TransformLookup& transforms, std::function<bool()> is_ending)
      : node_(std::move(node)),
        commons_(commons),
        octomap_(maps, jobs, commons.ledger),
        jobs_(jobs),
        prepare_obstacles_(prepare_obstacles),
        newest_(std::move(newest)),
        is_ending_(std::move(is_ending)) {
    if (!commons.settings.params.moveit_services) return;
    services_.emplace(node_, commons, octomap_, gaps_, newest_, prepare_obstacles, change_world);
    validity_.emplace(query_node, commons, newest_, transforms);
  }

  void startTopics() {
    if (!commons_.settings.params.moveit_topics) return;
    topics_.emplace(node_, commons_, octomap_, gaps_, newest_, prepare_obstacles_, jobs_, is_ending_);
  }
  void stopTopics() { topics_.reset(); }

 private:
  ros::NodeHandle node_;
  Commons& commons_;
  SceneOctomap octomap_;
  SceneGaps gaps_;  // only jobs use it
  TickJobs& jobs_;
  PrepareObstacles prepare_obstacles_;
  NewestTick newest_;
  std::function<bool()> is_ending_;
  std::optional<SceneTopics> topics_;
  std::optional<SceneServices> services_;
  std::optional<ValidityService> validity_;
};

}  // namespace hgrid
