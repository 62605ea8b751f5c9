// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

#include <ros/node_handle.h>

#include <functional>
#include <memory>
#include <vector>

#include "node/health/commons.h"
#include "node/tick/tick_jobs.h"
#include "node/tracks/track_source.h"

namespace hgrid {

/// Owns the objects that read the trackers of ~tracks, and passes their tracks to the world.
class Trackers {
 public:
  /// @param node    the names of topics are resolved in its namespace
  /// @param newest  returns the newest tick; any thread may call it
  /// All references must outlive this object.
  Trackers(ros::NodeHandle node, Commons& commons, const TransformLookup& transforms,
           std::function<std::shared_ptr<const Tick>()> newest, TickJobs& jobs)
      : node_(std::move(node)), commons_(commons), transforms_(transforms), newest_(std::move(newest)), jobs_(jobs) {}

  void start();
  void stop() { sources_.clear(); }

 private:
  ros::NodeHandle node_;
  Commons& commons_;
  const TransformLookup& transforms_;
  std::function<std::shared_ptr<const Tick>()> newest_;
  TickJobs& jobs_;
  std::vector<std::unique_ptr<TrackSource>> sources_;
};

}  // namespace hgrid
