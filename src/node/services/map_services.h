// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

#include <hgrid_proximity/ClearMap.h>
#include <hgrid_proximity/LoadOctomap.h>
#include <ros/node_handle.h>

#include <functional>
#include <string>
#include <vector>

#include "node/services/admin_answer.h"
#include "node/sources/map_source.h"
#include "node/wire/checked.h"

namespace hgrid {

/// Serves ~load_octomap and ~clear_map. A map is read on the thread that serves, while the world goes on with the old
/// one; a tick only takes it over.
class MapServices {
 public:
  /// Told of a map that was loaded or taken away; an empty name is all: nothing older may take its place.
  using Decided = std::function<void(const std::string& map)>;

  MapServices(ros::NodeHandle& node, const MapSource& source, AdminAnswer answer, Decided decided);

 private:
  bool onLoad(Checked<msg::LoadOctomap::Request>& checked, msg::LoadOctomap::Response& response);
  bool onClear(Checked<msg::ClearMap::Request>& checked, msg::ClearMap::Response& response);

  const MapSource& source_;
  AdminAnswer answer_;
  Decided decided_;
  std::vector<ros::ServiceServer> servers_;
};

}  // namespace hgrid
