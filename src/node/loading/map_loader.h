// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

#include <ros/node_handle.h>
#include <ros/subscriber.h>

#include <functional>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "node/health/ledger.h"
#include "node/health/start_grace.h"
#include "node/loading/pending_loads.h"
#include "node/params/params.h"
#include "node/sources/map_source.h"
#include "node/tick/tick_jobs.h"

namespace hgrid {

/// Puts the configured maps into the world: maps from files at the start, maps from topics when a message arrives.
///
/// Stores which files must still be read. Many maps are published only once. So it also stores the received maps that
/// could not be put into the world yet. Only one thread may use this object. The tick thread must not use it.
class MapLoader {
 public:
  /// All parameters except `node` must outlive this object.
  /// @param node    its callback queue must be that of the thread that uses this object
  /// @param stored  these maps take precedence over the files of the parameters
  MapLoader(ros::NodeHandle& node, const Params& params, const MapSource& source, const StoredMaps& stored,
            TickJobs& jobs, Ledger& ledger);

  /// Whether loadMissing() has something to do.
  bool hasMissing() const { return !files_.empty() || !arrived_.empty(); }
  /// Tries to put every missing map into the world. Each failure is counted and reported on ~status.
  void loadMissing();
  /// Drops the files and messages of this map that still wait to be loaded. An empty name means all maps. Call this
  /// after a service has loaded or removed the map.
  void forget(const std::string& map);

 private:
  void subscribe(ros::NodeHandle& node, const MapParams& map);
  void onMessage(const MapParams& map, const OctomapMessage& message);
  bool put(const MapParams& map, const std::function<LoadedMap()>& load);
  bool putGuarded(const MapParams& map, const std::function<LoadedMap()>& load);

  const MapSource& source_;
  TickJobs& jobs_;
  Ledger& ledger_;
  const StartGrace grace_;
  PendingLoads<MapParams> files_;
  PendingLoads<ReadMap> arrived_;
  std::vector<ros::Subscriber> subscribers_;
};

}  // namespace hgrid
