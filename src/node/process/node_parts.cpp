// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#include "node/process/node_parts.h"

#include <ros/init.h>
#include <ros/time.h>

#include <chrono>
#include <utility>

#include "node/health/guarded.h"
#include "node/threads/realtime.h"
#include "node/time/ros_time.h"

namespace hgrid {
namespace {

constexpr std::chrono::milliseconds kDiagnosticsPause{1000};

/// Returns a number that no earlier run of the node used: the time of the wall clock [ns].
std::uint64_t newEpoch() {
  return static_cast<std::uint64_t>(std::chrono::system_clock::now().time_since_epoch().count());
}

/// Returns a copy of a node handle whose callbacks go to `queue`.
ros::NodeHandle withQueue(ros::NodeHandle node, ros::CallbackQueueInterface& queue) {
  node.setCallbackQueue(&queue);
  return node;
}

}  // namespace

NodeParts::NodeParts(const ros::NodeHandle& node, const ros::NodeHandle& private_node,
                     std::shared_ptr<NarrowPhase> narrow_phase)
    : tick_thread_(node, private_node),
      query_threads_(node, private_node),
      batch_threads_(node, private_node),
      admin_thread_(node, private_node),
      quick_queries_(*query_threads_.privateNode().getCallbackQueue()),
      commons_{readSettings(private_node), std::move(narrow_phase), {}, {}},
      state_(commons_),
      world_(std::make_shared<const Settings>(commons_.settings), ros::Time::isSimTime(), newEpoch(), commons_.ledger,
             commons_.narrow_phase, state_.restored()),
      jobs_([this] { return isEnding(); }, std::chrono::seconds(10), [this] { tick_thread_.wake(); }),
      auditor_(commons_),
      history_(commons_.settings.params, commons_.ledger),
      tick_loop_(tick_thread_.node(), tick_thread_.privateNode(), commons_.settings.params, world_, jobs_, history_,
                 stopwatch_, commons_.health, auditor_.listener(), commons_.ledger),
      publishers_(tick_thread_.privateNode(), admin_thread_.privateNode(), commons_, stopwatch_, sketch_),
      completeness_log_(std::chrono::steady_clock::now()),
      loading_(
          admin_thread_.node(), private_node, commons_, world_.transforms().lookup(),
          [this] { return tick_loop_.newest(); },
          [this](const std::function<void(RobotEntries&)>& edit) {
            return world_.prepareRobots(edit, tick_loop_.newest());
          },
          jobs_, world_.robots(), state_.restored().maps, [this] { return isEnding(); }),
      joint_state_topics_(node, commons_, joint_states_),
      guard_(batch_threads_.privateNode(), commons_, world_.transforms().lookup(), joint_states_),
      path_topics_(node, commons_, guard_, [this] { return tick_loop_.newest(); }),
      services_(
          withQueue(private_node, quick_queries_), query_threads_.privateNode(), batch_threads_.privateNode(),
          admin_thread_.privateNode(), commons_, [this] { return tick_loop_.newest(); }, prepareObstacles(),
          [this](const TickJobs::Job& job) { return changeWorld(job); }, world_.transforms().lookup(), history_,
          loading_, state_, guard_, stopwatch_, sketch_),
      moveit_(
          admin_thread_.node(), query_threads_.node(), commons_, loading_.mapSource(), jobs_, prepareObstacles(),
          [this](const TickJobs::Job& job) { return changeWorld(job); }, [this] { return tick_loop_.newest(); },
          world_.transforms().lookup(), [this] { return isEnding(); }),
      trackers_(
          admin_thread_.node(), commons_, world_.transforms().lookup(), [this] { return tick_loop_.newest(); }, jobs_),
      diagnostics_(
          admin_thread_.node(), admin_thread_.privateNode(), private_node.getNamespace(),
          [this] { return tick_loop_.newest(); }, commons_.health),
      marker_pace_(commons_.settings.params.marker_rate),
      housekeeping_(admin_thread_.node(), marker_pace_.period(), ChoreList(chores(), commons_.ledger)),
      reconfigure_(
          admin_thread_.privateNode(), commons_.settings, [this](const TickJobs::Job& job) { return changeWorld(job); },
          [this](const Params& params) { takeOver(params); }, commons_.ledger) {
  tick_loop_.setSteps(tickSteps());
  housekeeping_.start();
  query_threads_.setThreads(static_cast<std::uint32_t>(commons_.settings.params.query_threads));
  batch_threads_.setThreads(static_cast<std::uint32_t>(commons_.settings.params.batch_threads));
  admin_thread_.setThreads(1);
  // Later than the threads above: if threads are few, the first tick must not take all of them for ~threads.
  tick_thread_.startLoop([this] { beginTicks(); }, [this] { return tick_loop_.work(); });
  loading_.startClouds();
  moveit_.startTopics();
  trackers_.start();
  path_topics_.start();
}

/// Stops all threads that use the parts of the node.
void NodeParts::stop() {
  stopping_ = true;
  housekeeping_.stop();
  loading_.stopClouds();
  moveit_.stopTopics();
  trackers_.stop();
  path_topics_.stop();
  joint_state_topics_.stop();
  tick_thread_.stop();
  quick_queries_.stop();
  query_threads_.stop();
  batch_threads_.stop();
  admin_thread_.stop();
}

PrepareObstacles NodeParts::prepareObstacles() const {
  return [this](const ObstacleChanges& changes, const std::vector<PairRule>* rules) {
    const Time now = fromRos(ros::Time::now());
    return world_.prepareObstacles(changes, tick_loop_.newest(), now, rules);
  };
}

/// Implements ChangeWorld. A client finds the change in ~bodies and ~rules when the answer arrives.
std::shared_ptr<const Tick> NodeParts::changeWorld(const TickJobs::Job& job) {
  std::shared_ptr<const Tick> tick = tick_loop_.tickAfter(job);
  publishers_.waitForStructure();
  return tick;
}

/// Takes over those parameters that may change while the node runs and that no tick uses. The admin thread calls this.
void NodeParts::takeOver(const Params& params) {
  query_threads_.setThreads(static_cast<std::uint32_t>(params.query_threads));
  marker_pace_.setRate(params.marker_rate);
  housekeeping_.setPeriod(marker_pace_.period());
}

/// Prepares the tick thread, which calls this before the first tick.
void NodeParts::beginTicks() {
  const int priority = commons_.settings.params.realtime;
  guarded(commons_.ledger, "realtime.failed", [&] {
    if (priority > 0) makeRealtime(priority);
  });
}

bool NodeParts::isEnding() const { return stopping_ || ros::isShuttingDown(); }

/// Returns what the tick thread does with every tick, in this order.
std::vector<TickLoop::Step> NodeParts::tickSteps() {
  using TickPtr = std::shared_ptr<const Tick>;
  // First of all, so that nothing can fail before: a request is answered only after its changes were collected.
  return {{"", [this](const TickPtr& tick) { state_.see(world_, *tick); }},
          {"tick.publish", [this](const TickPtr& tick) { publishers_.publishTick(tick); }, true},
          {"history", [this](const TickPtr& tick) { history_.see(*tick); }},
          {"",
           [this](const TickPtr& tick) {
             if (const auto time = publishers_.publishDistances(tick)) stopwatch_.add("distances", *time);
           }},
          {"",
           [this](const TickPtr& tick) {
             if (tick->snapshot)
               commons_.health.noteThreads("~threads", commons_.settings.params.threads, tick->threads);
           }},
          {"guard", [this](const TickPtr& tick) { guard_.see(tick); }},
          {"", [this](const TickPtr& tick) { completeness_log_.log(*tick); }},
          {"", [this](const TickPtr& tick) { model_log_.log(tick->models); }},
          {"audit", [this](const TickPtr& tick) { auditor_.see(tick); }}};
}

/// Returns what the admin thread does at regular times, in this order.
std::vector<Chore> NodeParts::chores() {
  using Time = Chore::Time;
  constexpr std::chrono::milliseconds kAlways{0};
  return {{"loading.failed", kAlways, [this](Time now) { loading_.retry(now); }},
          {"loading.failed", kAlways, [this](Time) { loading_.robots().loadChanged(); }},
          {"markers.failed", kAlways,
           [this](Time now) {
             if (marker_pace_.takeDue(now)) publishers_.publishMarkers(tick_loop_.newest());
           }},
          {"guard.joint_states.failed", kAlways,
           [this](Time) {
             if (const auto newest = tick_loop_.newest()) joint_state_topics_.follow(*newest);
           }},
          {"leases.failed", kAlways,
           [this](Time) {
             if (const auto newest = tick_loop_.newest()) services_.dropUnused(newest->epoch);
           }},
          {"diagnostics.failed", kDiagnosticsPause, [this](Time) { diagnostics_.update(); }}};
}

}  // namespace hgrid
