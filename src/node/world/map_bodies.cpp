// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#include "node/world/map_bodies.h"

#include <utility>

#include "node/params/body_params.h"

namespace hgrid {

Body mapBodyOf(const LoadedMap& map, const std::string& world_frame, const Params& params) {
  checkWithin(map.params.frame_from_map.translation(), params.world_limit,
              "map '" + map.params.name + "': its position in its frame");
  Body body;
  body.name = SourceId::ofMap(map.params.name).name;
  body.kind = BodyKind::map;
  body.frame = map.params.frame.empty() ? world_frame : map.params.frame;
  body.frame_from_body = map.params.frame_from_map;
  body.mobility = body.frame == world_frame ? Mobility::fixed : Mobility::moving;
  applyMaxSpeed(params, body);
  applyPatterns(params, body);
  return body;
}

bool MapBodies::hasSame(const SourceId& map, const Body& body) const {
  const auto known = seats_.find(map);
  return known != seats_.end() && known->second.frame == body.frame &&
         known->second.frame_from_map.matrix() == body.frame_from_body.matrix();
}

void MapBodies::set(const SourceId& map, const Body& body, const LoadedMap& loaded) {
  seats_.insert_or_assign(map, Seat{body.frame, body.frame_from_body});
  news_.noteAccepted(map.name, loaded);
}

bool MapBodies::noteRefused(const SourceId& map, const std::string& sentence) {
  if (!has(map)) return false;
  news_.noteRefused(map.name, sentence);
  return true;
}

void MapBodies::swap(MapBodies& other) noexcept {
  seats_.swap(other.seats_);
  std::swap(news_, other.news_);
}

}  // namespace hgrid
