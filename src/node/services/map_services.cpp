// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#include "node/services/map_services.h"

#include "hgrid_proximity/bodies/name.h"
#include "hgrid_proximity/refusal.h"
#include "node/services/guarded.h"
#include "node/tf/frames.h"

namespace hgrid {

MapServices::MapServices(ros::NodeHandle& node, const MapSource& source, AdminAnswer answer, Decided decided)
    : source_(source), answer_(std::move(answer)), decided_(std::move(decided)) {
  servers_.push_back(advertiseGuarded(node, "load_octomap", &MapServices::onLoad, this, answer_.ledger));
  servers_.push_back(advertiseGuarded(node, "clear_map", &MapServices::onClear, this, answer_.ledger));
}

bool MapServices::onLoad(Checked<msg::LoadOctomap::Request>& checked, msg::LoadOctomap::Response& response) {
  const auto begin = std::chrono::steady_clock::now();
  return answer_("load_octomap", response, [&](std::shared_ptr<const Tick>& tick) {
    const msg::LoadOctomap::Request& request = checked.value();
    MapParams map;
    map.name = request.map;
    map.file = request.file;
    map.frame = withoutSlash(request.header.frame_id);
    const auto& p = request.pose.position;
    const auto& q = request.pose.orientation;
    const bool unset = q.x == 0.0 && q.y == 0.0 && q.z == 0.0 && q.w == 0.0;  // as typed by hand
    map.frame_from_map = checkedPose(
        {p.x, p.y, p.z}, unset ? Eigen::Vector4d(0, 0, 0, 1) : Eigen::Vector4d(q.x, q.y, q.z, q.w), "the map's pose");
    const LoadedMap loaded = source_.finished(source_.read(map));
    tick = answer_.do_in_tick([loaded](World& world) { world.setMap(loaded); });
    decided_(request.map);
    response.occupied_leaves = loaded.cells->grid->size();
    response.resolution = loaded.cells->grid->finestEdge();
    response.duration = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
  });
}

bool MapServices::onClear(Checked<msg::ClearMap::Request>& checked, msg::ClearMap::Response& response) {
  return answer_("clear_map", response, [&](std::shared_ptr<const Tick>& tick) {
    const std::string map = checked.value().map;
    tick = answer_.do_in_tick([map](World& world) { world.clearMap(map); });
    decided_(map);
  });
}

}  // namespace hgrid
