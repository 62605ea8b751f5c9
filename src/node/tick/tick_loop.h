// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

#include <ros/node_handle.h>
#include <ros/steady_timer.h>

#include <chrono>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "node/diagnostics/ledger.h"
#include "node/diagnostics/node_health.h"
#include "node/params/params.h"
#include "node/tf/tf_reader.h"
#include "node/tick/stopwatch.h"
#include "node/tick/tick_jobs.h"
#include "node/world/world.h"

namespace hgrid {

/// Makes the ticks, ~rate times a second: reads the transforms that wait, does the jobs that wait, has the World make a
/// Tick, and passes it to the steps that publish it.
///
/// If a tick fails, the last one stays the newest; its age shows that there is no newer one.
class TickLoop {
 public:
  /// One thing that is done with every new tick.
  struct Step {
    std::string timing;  ///< the part of the stopwatch that it counts as; empty: none
    std::function<void(const std::shared_ptr<const Tick>&)> act;
  };

  /// @param node  its callback queue is that of the tick thread. All other parameters must outlive this object; the
  /// tick thread alone may use `world` and `stopwatch`.
  TickLoop(ros::NodeHandle node, const Params& params, World& world, TickJobs& jobs, Stopwatch& stopwatch,
           NodeHealth& health, Ledger& ledger);

  /// Starts to tick. Call this once. @param steps  done with every tick, in this order
  void start(std::vector<Step> steps);
  void stop() { timer_.stop(); }

  /// The newest tick; null before the first. Any thread.
  std::shared_ptr<const Tick> newest() const { return std::atomic_load(&newest_); }
  /// Does a job at the begin of a tick, waits until that tick is published, and returns it. Any thread but the tick
  /// thread. @throws as TickJobs::run()
  std::shared_ptr<const Tick> tickAfter(const TickJobs::Job& job);

 private:
  void takeTransforms(const tf2_msgs::TFMessage& message, bool is_static, const std::string& publisher,
                      const Moment& received);
  void onTimer(const ros::SteadyTimerEvent& event);
  void makeTick(const ros::SteadyTimerEvent& event);
  void noteLateness(const ros::SteadyTimerEvent& event);
  void act(const std::shared_ptr<const Tick>& tick);

  ros::NodeHandle node_;
  const ros::WallDuration period_;
  World& world_;
  TickJobs& jobs_;
  Stopwatch& stopwatch_;
  NodeHealth& health_;
  Ledger& ledger_;
  std::shared_ptr<const Tick> newest_;          // atomic access only
  std::chrono::nanoseconds transform_time_{0};  // spent on transforms since the last tick
  std::vector<Step> steps_;
  TfReader transforms_;
  ros::SteadyTimer timer_;
};

}  // namespace hgrid
