// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

#include <hgrid_proximity/ReloadRobot.h>
#include <ros/callback_queue.h>
#include <ros/node_handle.h>
#include <ros/spinner.h>
#include <ros/steady_timer.h>
#include <std_srvs/Trigger.h>

#include <atomic>
#include <functional>
#include <memory>
#include <mutex>
#include <vector>

#include "hgrid_proximity/distances/pair_meter.h"
#include "node/diagnostics/node_diagnostics.h"
#include "node/messages/events_messages.h"
#include "node/messages/markers.h"
#include "node/messages/messages.h"
#include "node/messages/pairs_messages.h"
#include "node/services/allowed_services.h"
#include "node/services/explain_service.h"
#include "node/services/map_services.h"
#include "node/services/query_services.h"
#include "node/sources/cloud_source.h"
#include "node/sources/robot_source.h"
#include "node/tf/tf_reader.h"
#include "node/tick/stopwatch.h"
#include "node/tick/tick_jobs.h"
#include "node/tick/world.h"
#include "node/wire/checked.h"

namespace hgrid {

/// The node: three callback queues that do not wait for each other.
///
/// - On the first, one thread reads transforms and ticks.
/// - On the second, ~query_threads threads answer queries from the newest tick.
/// - On the third, one thread loads robots and maps, serves the requests that change the world, and publishes
/// diagnostics
///   and markers.
class ProximityNode {
 public:
  /// @throws std::invalid_argument listing every wrong parameter
  ProximityNode(ros::NodeHandle node, ros::NodeHandle private_node);
  /// With another narrow phase than FCL's.
  ProximityNode(ros::NodeHandle node, ros::NodeHandle private_node, std::shared_ptr<NarrowPhase> narrow_phase);
  ~ProximityNode();

 private:
  using Job = TickJobs::Job;

  std::shared_ptr<const Tick> newest() const { return std::atomic_load(&newest_); }
  void takeTransforms(const tf2_msgs::TFMessage& message, bool is_static, const std::string& publisher,
                      const Moment& received);
  void onTick(const ros::SteadyTimerEvent& event);
  void makeTick(const ros::SteadyTimerEvent& event);
  void noteConflicts();
  void publish(const std::shared_ptr<const Tick>& tick);
  void measure(const std::shared_ptr<const Tick>& tick);
  void logChange(const Tick& tick);
  void onHousekeeping();
  void publishMarkers();
  /// Reads a robot and puts it into the world; the sentence of the refusal, or an empty one.
  Refusal loadRobot(const RobotParams& robot);
  Refusal putMap(const MapParams& map, const std::function<LoadedMap()>& load);
  void onMap(const MapParams& map, const OctomapMessage& message);
  void forgetPending(const std::string& map);
  void addCloud(const CloudParams& cloud);
  void loadMissing();
  void runInTick(const Job& job);
  void noteMissing(const SourceId& source, const std::string& sentence);
  bool isEnding() const;
  void waitForTick();
  std::shared_ptr<const Tick> tickAfter(const Job& job);
  bool onReset(Checked<std_srvs::Trigger::Request>& checked, std_srvs::Trigger::Response& response);
  bool onReload(Checked<msg::ReloadRobot::Request>& checked, msg::ReloadRobot::Response& response);
  msg::Code reload(const std::string& robot_name);
  NodeHealth health() const;

  ros::CallbackQueue update_queue_, query_queue_, admin_queue_;  // first: what uses them goes before them
  ros::NodeHandle update_node_, update_private_, query_private_, admin_node_, admin_private_;
  Params params_;
  std::uint64_t config_hash_;
  Ledger ledger_;
  QuerySketch sketch_;
  std::shared_ptr<NarrowPhase> narrow_phase_;
  RobotSource robot_source_;
  World world_;  // of the update thread, see runInTick()
  SelfShapes self_shapes_;
  MapSource map_source_;
  Stopwatch stopwatch_;
  std::shared_ptr<const Tick> newest_;
  std::shared_ptr<const MeasuredTick> measured_;  // null while nobody asks for distances
  std::atomic<bool> stopping_{false};

  TickJobs jobs_;
  mutable std::mutex mutex_;
  NodeHealth health_;  // guarded by mutex_

  // Of the update thread.
  PairsMessages pairs_messages_;
  PairMeter meter_;
  std::uint64_t published_revision_ = 0, published_epoch_ = 0;
  std::chrono::nanoseconds tf_time_{0};  // spent on transforms since the last tick
  std::size_t known_conflicts_ = 0;
  bool was_complete_ = false;
  std::string last_reason_;
  const std::chrono::steady_clock::time_point started_ = std::chrono::steady_clock::now();
  // Of the admin thread.
  std::vector<std::string> to_load_;
  std::vector<MapParams> maps_to_load_;
  std::vector<ReadMap> arrived_maps_;  // of topics, that the world could not take yet
  double retry_after_ = 0.0;
  std::chrono::steady_clock::time_point next_try_{}, next_diagnostics_{};
  std::size_t viewers_ = 0;

  ros::Publisher pairs_, distances_, events_, status_, bodies_, markers_;
  std::unique_ptr<TfReader> transforms_;
  std::vector<ros::Subscriber> subscribers_;
  std::vector<ros::ServiceServer> servers_;
  std::unique_ptr<QueryServices> queries_;
  std::unique_ptr<ExplainService> explain_;
  std::unique_ptr<AllowedServices> allowed_;
  std::unique_ptr<MapServices> maps_;
  std::vector<std::unique_ptr<CloudSource>> clouds_;
  std::unique_ptr<NodeDiagnostics> diagnostics_;
  ros::SteadyTimer tick_timer_, housekeeping_timer_;
  std::vector<std::unique_ptr<ros::AsyncSpinner>> spinners_;
};

}  // namespace hgrid
