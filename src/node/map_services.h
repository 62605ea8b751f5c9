// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

#include <hgrid_proximity/ClearMap.h>
#include <hgrid_proximity/LoadOctomap.h>
#include <ros/node_handle.h>

#include <functional>
#include <memory>
#include <vector>

#include "ledger.h"
#include "map_source.h"
#include "messages.h"
#include "world.h"

namespace hgrid {

/// Serves ~load_octomap and ~clear_map. A map is read on the thread that serves, while the world goes on with the old
/// one; a tick only takes it over.
class MapServices {
 public:
  using NewestTick = std::function<std::shared_ptr<const Tick>()>;
  /// Does a job at the begin of a tick and waits for the result of that tick.
  /// @throws Refusal busy
  using DoInTick = std::function<std::shared_ptr<const Tick>(const std::function<void(World&)>&)>;

  MapServices(ros::NodeHandle& node, const Params& params, std::uint64_t config_hash, const MapSource& source,
              NewestTick newest, DoInTick do_in_tick, Ledger& ledger);

 private:
  bool onLoad(msg::LoadOctomap::Request& request, msg::LoadOctomap::Response& response);
  bool onClear(msg::ClearMap::Request& request, msg::ClearMap::Response& response);
  template <class Response, class Deed>
  bool answer(const char* what, Response& response, Deed&& deed);

  const Params& params_;
  std::uint64_t config_hash_;
  const MapSource& source_;
  NewestTick newest_;
  DoInTick do_in_tick_;
  Ledger& ledger_;
  std::vector<ros::ServiceServer> servers_;
};

}  // namespace hgrid
