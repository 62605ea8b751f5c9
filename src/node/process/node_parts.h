// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

#include <ros/node_handle.h>

#include <atomic>
#include <memory>
#include <vector>

#include "node/audit/auditor.h"
#include "node/diagnostics/completeness_log.h"
#include "node/diagnostics/model_log.h"
#include "node/diagnostics/node_diagnostics.h"
#include "node/guard/guard.h"
#include "node/guard/joint_state_topics.h"
#include "node/guard/path_topics.h"
#include "node/health/commons.h"
#include "node/loading/loading.h"
#include "node/loading/trackers.h"
#include "node/loop/tick_loop.h"
#include "node/moveit/moveit_interface.h"
#include "node/process/housekeeping.h"
#include "node/publishers/publishers.h"
#include "node/reconfigure/reconfigure_service.h"
#include "node/services/node_services.h"
#include "node/state/state_keeper.h"
#include "node/threads/callback_threads.h"
#include "node/threads/quick_callbacks.h"
#include "node/tick/tick_history.h"

namespace hgrid {

/// The parts of the node. It connects them, and starts and stops them. Its callbacks run on four groups of threads,
/// which do not wait for each other:
///
/// - the tick thread reads transforms, computes the ticks and publishes them;
/// - the query threads, as many as ~query_threads says, answer queries from the newest tick; the thread of roscpp that
///   receives answers short ones itself;
/// - the batch threads, as many as ~batch_threads says, answer requests with thousands of questions, which may take
///   seconds;
/// - the admin thread loads robots and maps, serves requests that change the world, publishes diagnostics and markers.
class NodeParts {
 public:
  /// @throws std::invalid_argument with a message that lists every wrong parameter
  NodeParts(const ros::NodeHandle& node, const ros::NodeHandle& private_node,
            std::shared_ptr<NarrowPhase> narrow_phase);

 private:
  void stop();
  /// Returns whether the node or its process is about to end. Long work must then stop. Any thread may call this.
  bool isEnding() const;
  void beginTicks();
  std::vector<TickLoop::Step> tickSteps();
  std::vector<Chore> chores();
  PrepareObstacles prepareObstacles() const;
  std::shared_ptr<const Tick> changeWorld(const TickJobs::Job& job);
  void takeOver(const Params& params);

  // Each part uses only the parts that are declared above it.
  std::atomic<bool> stopping_{false};
  CallbackThreads tick_thread_, query_threads_, batch_threads_, admin_thread_;
  QuickCallbacks quick_queries_;
  Commons commons_;
  QuerySketch sketch_;
  StateKeeper state_;
  World world_;  // only the tick thread uses it, except for the functions that all threads may call
  TickJobs jobs_;
  Stopwatch stopwatch_;  // only the tick thread uses it
  Auditor auditor_;
  TickHistory history_;
  TickLoop tick_loop_;
  Publishers publishers_;
  CompletenessLog completeness_log_;
  ModelLog model_log_;
  Loading loading_;
  JointStates joint_states_;
  JointStateTopics joint_state_topics_;
  Guard guard_;
  PathTopics path_topics_;
  NodeServices services_;
  MoveItInterface moveit_;
  Trackers trackers_;
  NodeDiagnostics diagnostics_;
  ChorePace marker_pace_;  // only the admin thread uses it
  Housekeeping housekeeping_;
  ReconfigureService reconfigure_;
  /// Stops all threads before any part is destroyed, also if the constructor throws after some threads were started.
  struct StopsThreads {
    NodeParts& node;
    ~StopsThreads() { node.stop(); }
  } stops_threads_{*this};
};

}  // namespace hgrid
