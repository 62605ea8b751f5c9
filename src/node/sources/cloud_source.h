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
#include "node/diagnostics/ledger.h"
#include "node/params/params.h"
#include "node/sources/loaded_map.h"
#include "node/sources/self_shapes.h"
#include "node/wire/cloud_message.h"

namespace hgrid {

/// Makes the cells of one cloud of its messages, on a thread of its own: ticks and queries do not wait for it, and what
/// comes faster than it can be read is dropped, the oldest first.
class CloudSource {
 public:
  /// What becomes of it. Both may be called on the source's thread only.
  struct Sink {
    std::function<void(const LoadedCloud&)> put;            // into the world; throws Refusal
    std::function<void(const std::string& sentence)> miss;  // why nothing could be put
  };

  /// @param node  in whose namespace the topic is
  CloudSource(const ros::NodeHandle& node, const CloudParams& cloud, const Params& params,
              const SelfShapes& self_shapes, const tf2::BufferCore& buffer,
              std::shared_ptr<const NarrowPhase> narrow_phase, SelfShapes::NewestTick newest, Sink sink,
              Ledger& ledger);
  ~CloudSource();

 private:
  void onMessage(const CloudMessage& message);
  void take(const CloudMessage& message);
  void onTimer();
  void waitFor(const std::string& world_frame, const std::string& frame, Time stamp) const;
  Pose sensorPose(const std::string& frame, const std::string& world_frame, Time stamp) const;
  std::vector<Voxel> voxelsOf(PointCloud cloud, const Pose& world_from_sensor, Time stamp);
  void noteNewest(Time stamp, Time now, std::chrono::steady_clock::time_point received, const Eigen::Vector3d& sensor);
  void put();
  Time cellTime() const;

  CloudParams cloud_;
  std::string what_;     // in refusals
  std::string counter_;  // what the names of its counters begin with
  std::string failed_;   // the counter of exceptions in its callbacks
  bool simulated_;       // /clock drives ROS time
  const Params& params_;
  const SelfShapes& self_shapes_;
  const tf2::BufferCore& buffer_;
  std::shared_ptr<const NarrowPhase> narrow_phase_;
  SelfShapes::NewestTick newest_;
  Sink sink_;
  Ledger& ledger_;

  std::atomic<bool> stopping_{false};
  CloudCells cells_;
  LoadedCloud loaded_;
  ros::CallbackQueue queue_;
  ros::NodeHandle node_;
  ros::Subscriber subscriber_;
  ros::SteadyTimer timer_;
  std::unique_ptr<ros::AsyncSpinner> spinner_;
};

}  // namespace hgrid
