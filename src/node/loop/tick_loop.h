// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

#include <ros/node_handle.h>

#include <chrono>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "node/health/ledger.h"
#include "node/health/node_health.h"
#include "node/loop/tick_pace.h"
#include "node/params/params.h"
#include "node/tf/tf_reader.h"
#include "node/threads/stopwatch.h"
#include "node/tick/tick_history.h"
#include "node/tick/tick_jobs.h"
#include "node/world/world.h"

namespace hgrid {

/// Makes ticks when the TickPace says so: as soon as the transforms for a newer time are there, or a job waits. Each
/// tick reads the waiting transforms, does the waiting jobs, lets the World make a Tick, and passes that Tick to the
/// steps that publish it.
///
/// If a tick fails, the previous one remains the newest one.
class TickLoop {
 public:
  /// A function that is called with every new tick.
  struct Step {
    std::string timing;  ///< name of its duration in the stopwatch; empty: not measured
    std::function<void(const std::shared_ptr<const Tick>&)> act;
    bool publishes = false;  ///< whether the timing "latency" ends after this step
  };

  /// All parameters except `node` must outlive this object. Only the tick thread may use `world` and `stopwatch`.
  /// Between ticks, the thread that receives transforms uses the transforms of `world`, too (see TfReader).
  /// @param node      its callback queue must be that of the tick thread
  /// @param private_node  node handle whose namespace contains the topic "poses"
  /// @param history   the past ticks; each new tick says which of them queries can ask about
  /// @param listener  learns which messages of /tf and ~poses were read; may be null
  TickLoop(ros::NodeHandle node, const ros::NodeHandle& private_node, const Params& params, World& world,
           TickJobs& jobs, const TickHistory& history, Stopwatch& stopwatch, NodeHealth& health, TfListener* listener,
           Ledger& ledger);

  /// Sets what is called with every tick, in this order. Call this once, before the first work().
  void setSteps(std::vector<Step> steps) { steps_ = std::move(steps); }
  /// Makes a tick if one is due. The tick thread calls this after each round of callbacks.
  /// @returns how long the thread may wait for the next callback until it must call this again
  std::chrono::nanoseconds work();

  /// Returns the newest tick, or null before the first tick. Any thread may call this.
  std::shared_ptr<const Tick> newest() const { return std::atomic_load(&newest_); }
  /// Does a job at the beginning of a tick, waits until that tick is published, and returns that tick. Any thread
  /// except the tick thread may call this. @throws the same as TickJobs::run(); Refusal busy if the job was done, but
  /// no tick was published in time, and its sentence says so
  std::shared_ptr<const Tick> tickAfter(const TickJobs::Job& job);

 private:
  bool takeTransforms(const std::vector<TransformView>& transforms, bool is_static, const std::string& publisher,
                      const Moment& received);
  void makeTick();
  void noteLateness(bool late);
  void act(const std::shared_ptr<const Tick>& tick);

  ros::NodeHandle node_;
  TickPace pace_;
  World& world_;
  TickJobs& jobs_;
  const TickHistory& history_;
  Stopwatch& stopwatch_;
  NodeHealth& health_;
  Ledger& ledger_;
  std::shared_ptr<const Tick> newest_;  // use only atomic access
  // The next two members are used under a TfReader::Hold.
  std::chrono::nanoseconds transform_time_{0};  // time spent on transforms since the last tick
  std::optional<TickPace::Time> complete_;      // arrival of the transform that completed the data of the next tick
  std::vector<Step> steps_;
  TfReader transforms_;
};

}  // namespace hgrid
