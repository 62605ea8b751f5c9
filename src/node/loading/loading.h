// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

#include <ros/node_handle.h>

#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "node/health/commons.h"
#include "node/loading/map_loader.h"
#include "node/loading/retry_schedule.h"
#include "node/loading/robot_loader.h"
#include "node/sources/cloud_source.h"
#include "node/sources/self_shapes.h"
#include "node/tick/newest_tick.h"

namespace hgrid {

/// Owns the objects that load robots, maps and clouds, and retries failed loads. Only one thread may use this object.
/// The tick thread must not use it. Each cloud is read on a separate thread.
class Loading {
 public:
  /// @param node          its callback queue must be that of the thread that uses this object
  /// @param private_node  robot descriptions are searched from its namespace upwards
  /// @param robots        the robots of the world
  /// @param stored_maps   maps that services loaded or removed in an earlier run of the node
  /// @param is_ending     returns whether the node is shutting down; loads are then canceled. Any thread may call it.
  Loading(ros::NodeHandle node, const ros::NodeHandle& private_node, Commons& commons,
          const TransformLookup& transforms, NewestTick newest, PrepareRobots prepare_robots, TickJobs& jobs,
          const RobotModels& robots, const StoredMaps& stored_maps, std::function<bool()> is_ending);

  void startClouds();
  void stopClouds() { clouds_.clear(); }

  /// Tries again to load missing robots and maps, if a retry is due: at first often, then every ten seconds.
  void retry(RetrySchedule::Time now);

  RobotLoader& robots() { return robots_; }
  MapLoader& maps() { return maps_; }
  const MapSource& mapSource() const { return map_source_; }
  /// Returns the function `is_ending` of the constructor.
  const std::function<bool()>& isEnding() const { return is_ending_; }

 private:
  void startCloud(const CloudParams& cloud);

  ros::NodeHandle node_;
  Commons& commons_;
  const TransformLookup& transforms_;
  NewestTick newest_;
  TickJobs& jobs_;
  const std::function<bool()> is_ending_;
  SelfShapes self_shapes_;
  RobotSource robot_source_;
  MapSource map_source_;
  RobotLoader robots_;
  MapLoader maps_;
  RetrySchedule schedule_;
  std::vector<std::unique_ptr<CloudSource>> clouds_;
};

}  // namespace hgrid
