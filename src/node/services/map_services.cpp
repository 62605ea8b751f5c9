// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#include "node/services/map_services.h"

#include <chrono>
#include <utility>

#include "hgrid_proximity/bodies/name.h"
#include "hgrid_proximity/refusal.h"
#include "node/text/frame_names.h"
#include "node/wire/from_messages.h"
#include "node/world/world.h"

namespace hgrid {
namespace {

/// @throws Refusal if the pose of the map is not valid
MapParams paramsOf(const msg::LoadOctomap::Request& request) {
  MapParams map;
  map.name = request.map;
  map.file = request.file;
  map.frame = withoutSlash(request.header.frame_id);
  map.frame_from_map = fromPose(request.pose, "the map's pose");
  return map;
}

}  // namespace

MapServices::MapServices(ServiceEnvelope& envelope, const MapSource& source, ChangeWorld change_world, Decided decided)
    : source_(source), change_world_(std::move(change_world)), decided_(std::move(decided)) {
  servers_.push_back(
      envelope.serve<msg::LoadOctomap>("load_octomap", [this](ServiceCall<msg::LoadOctomap>& call) { load(call); }));
  servers_.push_back(
      envelope.serve<msg::ClearMap>("clear_map", [this](ServiceCall<msg::ClearMap>& call) { clear(call); }));
}

void MapServices::load(ServiceCall<msg::LoadOctomap>& call) const {
  const auto begin = std::chrono::steady_clock::now();
  const MapParams map = paramsOf(call.request);
  const LoadedMap loaded = source_.finished(source_.read(map));
  call.tick = AnswerTick(change_world_([loaded](World& world) { world.setMap(loaded); }));
  call.response.durable = decided_(map.name, map);
  call.response.occupied_leaves = loaded.cells->grid->size();
  call.response.resolution = loaded.cells->grid->finestEdge();
  call.response.duration = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
}

void MapServices::clear(ServiceCall<msg::ClearMap>& call) const {
  const std::string map = call.request.map;
  call.tick = AnswerTick(change_world_([map](World& world) { world.clearMap(map); }));
  call.response.durable = decided_(map, std::nullopt);
}

}  // namespace hgrid
