// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

#include <ros/node_handle.h>
#include <ros/subscriber.h>

#include <functional>
#include <string>
#include <vector>

#include "node/diagnostics/ledger.h"
#include "node/loading/pending_loads.h"
#include "node/params/params.h"
#include "node/sources/map_source.h"
#include "node/tick/tick_jobs.h"

namespace hgrid {

/// Puts the configured maps into the world: those of files at the start, those of topics whenever a message comes.
///
/// It remembers which files are still to be read, and which messages the world could not take yet, because many maps
/// are published only once. One thread, not that of the ticks.
class MapLoader {
 public:
  /// @param node  its callback queue is that of the thread that uses this object. All other parameters must outlive it.
  MapLoader(ros::NodeHandle& node, const Params& params, const MapSource& source, TickJobs& jobs, Ledger& ledger);

  bool hasMissing() const { return !files_.empty() || !arrived_.empty(); }
  /// Tries to put every map that is missing into the world. Each that fails is reported by ~status and counted.
  void loadMissing();
  /// Forgets what is still to be loaded of this map (empty: of all maps), because a service has decided what it has.
  void forget(const std::string& map);

 private:
  void subscribe(ros::NodeHandle& node, const MapParams& map);
  void onMessage(const MapParams& map, const OctomapMessage& message);
  bool put(const MapParams& map, const std::function<LoadedMap()>& load);
  bool putGuarded(const MapParams& map, const std::function<LoadedMap()>& load);

  const MapSource& source_;
  TickJobs& jobs_;
  Ledger& ledger_;
  PendingLoads<MapParams> files_;
  PendingLoads<ReadMap> arrived_;
  std::vector<ros::Subscriber> subscribers_;
};

}  // namespace hgrid
