// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#include "map_services.h"

#include "frames.h"
#include "hgrid_proximity/refusal.h"
#include "hgrid_proximity/scene/name.h"

namespace hgrid {

MapServices::MapServices(ros::NodeHandle& node, const Params& params, std::uint64_t config_hash,
                         const MapSource& source, NewestTick newest, DoInTick do_in_tick, Ledger& ledger)
    : params_(params),
      config_hash_(config_hash),
      source_(source),
      newest_(std::move(newest)),
      do_in_tick_(std::move(do_in_tick)),
      ledger_(ledger) {
  servers_.push_back(node.advertiseService("load_octomap", &MapServices::onLoad, this));
  servers_.push_back(node.advertiseService("clear_map", &MapServices::onClear, this));
}

/// Does the deed, which returns the tick in which it is in force, and says how it went.
template <class Response, class Deed>
bool MapServices::answer(const char* what, Response& response, Deed&& deed) {
  std::shared_ptr<const Tick> tick;
  response.code = toMsg(Code::ok, "");
  try {
    tick = deed();
    response.success = true;
  } catch (const Refusal& refusal) {
    response.code = toMsg(refusal.code(), refusal.what());
    ledger_.refuse(std::string(what) + ".refused", refusal);
  } catch (const std::exception& error) {  // a fault of ours: the caller hears of it, the node goes on
    response.code = toMsg(Code::internal, error.what());
    ledger_.refuse(std::string(what) + ".failed", Refusal(Code::internal, error.what()));
  }
  if (!tick) tick = newest_();
  if (tick) {
    const std::chrono::duration<double> age = std::chrono::steady_clock::now() - tick->made.steady;
    response.world = worldState(*tick, params_, config_hash_, age.count());
  } else {
    response.world.worst_state = msg::WorldState::UNPLACED;
  }
  return true;
}

bool MapServices::onLoad(msg::LoadOctomap::Request& request, msg::LoadOctomap::Response& response) {
  const auto begin = std::chrono::steady_clock::now();
  return answer("load_octomap", response, [&] {
    MapParams map;
    map.name = request.map;
    map.file = request.file;
    map.frame = withoutSlash(request.header.frame_id);
    const auto& p = request.pose.position;
    const auto& q = request.pose.orientation;
    const bool unset = q.x == 0.0 && q.y == 0.0 && q.z == 0.0 && q.w == 0.0;  // as typed by hand
    map.frame_from_map = checkedPose(
        {p.x, p.y, p.z}, unset ? Eigen::Vector4d(0, 0, 0, 1) : Eigen::Vector4d(q.x, q.y, q.z, q.w), "the map's pose");
    const LoadedMap loaded = source_.load(map);
    const auto tick = do_in_tick_([loaded](World& world) { world.setMap(loaded); });
    response.occupied_leaves = loaded.cells->grid->size();
    response.resolution = loaded.cells->grid->finestEdge();
    response.duration = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
    return tick;
  });
}

bool MapServices::onClear(msg::ClearMap::Request& request, msg::ClearMap::Response& response) {
  return answer("clear_map", response,
                [&] { return do_in_tick_([map = request.map](World& world) { world.clearMap(map); }); });
}

}  // namespace hgrid
