// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

#include <hgrid_proximity/ClearMap.h>
#include <hgrid_proximity/LoadOctomap.h>

#include <functional>
#include <string>
#include <vector>

#include "node/services/envelope/service_envelope.h"
#include "node/sources/map_source.h"
#include "node/tick/change_world.h"

namespace hgrid {

/// Serves ~load_octomap and ~clear_map. The thread that serves reads a map while ticks go on with the old one; a tick
/// only takes over the new map.
class MapServices {
 public:
  /// Called when a map was loaded or removed; an empty name stands for all maps. An older map must not replace it
  /// later.
  using Decided = std::function<void(const std::string& map)>;

  /// @param envelope  must outlive this object, as `source` must
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
