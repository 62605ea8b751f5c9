// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

#include <ros/callback_queue.h>
#include <ros/node_handle.h>
#include <ros/spinner.h>
#include <ros/steady_timer.h>

#include <atomic>
#include <functional>
#include <memory>
#include <string>

#include "hgrid_proximity/maps/cloud_cells.h"
#include "node/health/ledger.h"
#include "node/health/start_grace.h"
#include "node/params/params.h"
#include "node/sources/loaded_map.h"
#include "node/sources/self_shapes.h"
#include "node/tick/newest_tick.h"
#include "node/wire/cloud_message.h"

namespace hgrid {

/// Converts the messages of one cloud to cells, on a separate thread.
///
/// Ticks and queries do not wait for that thread. If messages arrive faster than it can read them, the oldest
/// messages are dropped.
class CloudSource {
 public:
  /// Functions that receive the results. CloudSource calls them on its own thread.
  struct Sink {
    std::function<void(const std::string& frame)> follow;   // names the frame of the messages, once for each frame
    std::function<void(const LoadedCloud&)> put;            // puts the cells into the world; may throw Refusal
    std::function<void(const std::string& sentence)> miss;  // says why a message could not be used
  };

  /// @param node  the name of the topic is resolved in its namespace
  CloudSource(const ros::NodeHandle& node, const CloudParams& cloud, const Params& params,
              const SelfShapes& self_shapes, const TransformLookup& transforms,
              std::shared_ptr<const NarrowPhase> narrow_phase, NewestTick newest, Sink sink, Ledger& ledger);
  ~CloudSource();

 private:
  void onMessage(const CloudMessage& message);
  void take(const CloudMessage& message);
  void onTimer();
  void waitFor(const std::string& world_frame, const std::string& frame, Time stamp) const;
  Pose sensorPose(const std::string& frame, const std::string& world_frame, Time stamp) const;
  std::vector<Voxel> voxelsOf(PointCloud cloud, const Pose& world_from_sensor, Time stamp);
  void noteNewest(Time stamp, Time now, std::chrono::steady_clock::time_point received, const Eigen::Vector3d& sensor);
  void noteTooNear(Time stamp, Time now, std::uint64_t too_near, const Eigen::Vector3d& sensor);
  void put();
  Time cellTime() const;

  CloudParams cloud_;
  std::string what_;     // names the cloud in error sentences
  std::string counter_;  // prefix of the names of its counters
  std::string failed_;   // name of the counter of exceptions in its callbacks
  bool simulated_;       // whether /clock drives ROS time
  const Params& params_;
  const SelfShapes& self_shapes_;
  const TransformLookup& transforms_;
  std::shared_ptr<const NarrowPhase> narrow_phase_;
  NewestTick newest_;
  Sink sink_;
  Ledger& ledger_;
  const StartGrace grace_;

  std::atomic<bool> stopping_{false};
  std::string frame_;  // of the newest message
  CloudCells cells_;
  LoadedCloud loaded_;
  ros::CallbackQueue queue_;
  ros::NodeHandle node_;
  ros::Subscriber subscriber_;
  ros::SteadyTimer timer_;
  std::unique_ptr<ros::AsyncSpinner> spinner_;
};

}  // namespace hgrid
