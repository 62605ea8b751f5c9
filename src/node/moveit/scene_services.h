// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

#include <ros/node_handle.h>
#include <ros/service_server.h>

#include <vector>

#include "node/health/commons.h"
#include "node/moveit/scene_changes.h"
#include "node/moveit/scene_gaps.h"
#include "node/moveit/scene_octomap.h"
#include "node/tick/change_world.h"
#include "node/tick/newest_tick.h"
#include "node/wire/scene_types.h"

namespace hgrid {

/// Serves get_planning_scene and apply_planning_scene, with the types of moveit_msgs of Noetic.
class SceneServices {
 public:
  /// @param node  the names of the services are resolved in its namespace; the thread of its callback queue serves them
  /// `commons`, `octomap` and `gaps` must outlive this object.
  SceneServices(ros::NodeHandle node, Commons& commons, SceneOctomap& octomap, SceneGaps& gaps, NewestTick newest,
                PrepareObstacles prepare, ChangeWorld change_world);

 private:
  template <class Service>
  void serve(ros::NodeHandle& node, const char* name, const char* failed,
             void (SceneServices::*work)(const typename Service::Request&, typename Service::Response&));
  void get(const moveit::GetPlanningScene::Request& request, moveit::GetPlanningScene::Response& response);
  void apply(const moveit::ApplyPlanningScene::Request& request, moveit::ApplyPlanningScene::Response& response);

  Commons& commons_;
  SceneReader reader_;
  SceneOctomap& octomap_;
  SceneGaps& gaps_;  // only jobs use it
  NewestTick newest_;
  PrepareObstacles prepare_;
  ChangeWorld change_world_;
  std::vector<ros::ServiceServer> servers_;
};

}  // namespace hgrid
