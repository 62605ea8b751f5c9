// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

#include <hgrid_proximity/ClearMap.h>
#include <hgrid_proximity/LoadOctomap.h>

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "node/services/envelope/service_envelope.h"
#include "node/sources/map_source.h"
#include "node/tick/change_world.h"

namespace hgrid {

/// Serves ~load_octomap and ~clear_map. The thread that serves a request reads the map, while ticks continue with the
/// old map. A tick only replaces the old map by the finished one.
class MapServices {
 public:
  /// Called after a map was loaded or removed; an empty name means all maps. The callee must drop older loads of this
  /// map that are still pending.
  /// @param loaded  nullopt: the map was removed
  /// @returns whether the decision is on disk
  using Decided = std::function<bool(const std::string& map, const std::optional<MapParams>& loaded)>;

  /// `envelope` and `source` must outlive this object.
  MapServices(ServiceEnvelope& envelope, const MapSource& source, ChangeWorld change_world, Decided decided);

 private:
  void load(ServiceCall<msg::LoadOctomap>& call) const;
  void clear(ServiceCall<msg::ClearMap>& call) const;

  const MapSource& source_;
  ChangeWorld change_world_;
  Decided decided_;
  std::vector<ros::ServiceServer> servers_;
};

}  // namespace hgrid
