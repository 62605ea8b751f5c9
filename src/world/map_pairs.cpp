// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#include "world/map_pairs.h"

#include <algorithm>

#include "geometry/infinity.h"
#include "maps/map_gap.h"
#include "world/pair_margin.h"

namespace hgrid {

/// Prepares for a new structure: drops all stored gaps, because the proxies may have other ids. Keeps where each map
/// was in the last accepted tick.
void MapPairs::renumber(const Structure& structure) {
  std::vector<OfMap> next(structure.maps.size());
  for (std::size_t i = 0; i < next.size(); ++i) {
    next[i].id = structure.ids[structure.maps[i]];
    for (const OfMap& known : maps_) {
      if (known.id != next[i].id) continue;
      next[i].map_from_world_last = known.map_from_world_last;
      next[i].was_there = known.was_there;
    }
  }
  maps_.swap(next);
  revision_ = structure.revision;
}

/// Drops the stored gaps to maps that moved or that have other cells.
void MapPairs::recall(const Snapshot& snapshot) {
  const Structure& structure = snapshot.structure();
  if (revision_ != structure.revision) renumber(structure);
  for (std::size_t i = 0; i < maps_.size(); ++i) {
    OfMap& map = maps_[i];
    const Pose& pose = snapshot.poses()[structure.maps[i]].world_from_body;
    const std::shared_ptr<const MapCells> cells = snapshot.cellsOf(structure.maps[i]);
    if (map.cells == cells && map.world_from_map.matrix() == pose.matrix()) continue;
    map.gaps.assign(structure.body_of_proxy.size(), Gap{});  // this call comes first because it may throw
    map.world_from_map = pose;
    map.map_from_world = pose.inverse();
    map.cells = cells;
  }
}

void MapPairs::accept() {
  for (OfMap& map : maps_) {
    map.map_from_world_last = map.map_from_world;
    map.was_there = map.cells != nullptr;
  }
}

bool MapPairs::find(const Snapshot& snapshot, const Horizon& horizon, std::size_t most, const Add& add) {
  recall(snapshot);
  const Structure& structure = snapshot.structure();
  std::size_t left = most;
  for (std::size_t i = 0; i < maps_.size(); ++i) {
    const std::uint32_t map = structure.maps[i];
    if (snapshot.poses()[map].state == Freshness::unplaced || !maps_[i].cells) continue;
    for (std::uint32_t body = 0; body < structure.bodies.size(); ++body) {
      if (snapshot.poses()[body].state == Freshness::unplaced || structure.filter.allowed(body, map)) continue;
      if (!addShapes(maps_[i], map, body, snapshot, horizon, left, add)) return false;
    }
  }
  return true;
}

/// Returns whether a box may have come within the margin of a cell between the last tick and this tick. Compares in the
/// frame of the map, so a common movement of map and box does not count.
/// @param aside  [m] how far both can have been beside the straight way between their poses of both ticks, or can have
///                moved since their poses, which may be older than the tick
bool MapPairs::passed(const OfMap& map, ProxyId proxy, const Snapshot& snapshot, const Horizon& horizon, double margin,
                      double aside) const {
  const Aabb &from = horizon.before(proxy), &to = snapshot.boxes()[proxy];
  if (aside == 0.0 && from == to && map.mapFromWorldBefore().matrix() == map.map_from_world.matrix()) return false;
  const Eigen::AlignedBox3d swept = boxInMap(map.mapFromWorldBefore(), from, snapshot.origin())
                                        .merged(boxInMap(map.map_from_world, to, snapshot.origin()));
  return gapTo(*map.cells->grid, swept, margin + aside) <= margin + aside;
}

/// Adds the pairs of a map with the shapes of a body. `left` is the number of pairs that may still be added.
/// @param number  index of the map in Structure::bodies
/// @returns false if `left` was too small for all pairs
bool MapPairs::addShapes(OfMap& map, std::uint32_t number, std::uint32_t body, const Snapshot& snapshot,
                         const Horizon& horizon, std::size_t& left, const Add& add) const {
  const Structure& structure = snapshot.structure();
  const auto gapOf = [&](const Aabb& box, double up_to) {
    return gapTo(*map.cells->grid, boxInMap(map.map_from_world, box, snapshot.origin()), up_to);
  };
  const std::uint32_t first = std::min(body, number), second = std::max(body, number);
  const double margin =
      pairMargin(structure, body, stalenessOf(snapshot.poses()[body]), number, stalenessOf(snapshot.poses()[number]));
  const double can_go = horizon.reachOf(number) + horizon.reachOf(body), up_to = std::max(margin, can_go);
  const double aside =
      horizon.driftOf(number) + horizon.driftOf(body) + 0.5 * (horizon.wayOf(number) + horizon.wayOf(body));
  for (ProxyId proxy = structure.first_proxy[body]; proxy < structure.first_proxy[body + 1]; ++proxy) {
    const Aabb& box = snapshot.boxes()[proxy];
    Gap& known = map.gaps[proxy];
    if (known.up_to < up_to || known.box != box) known = {box, up_to, gapOf(box, up_to)};
    const bool near = known.gap <= margin, soon = known.gap <= can_go;
    if (!near && !soon && !(horizon.on() && passed(map, proxy, snapshot, horizon, margin, aside))) continue;
    if (left == 0) return false;
    --left;
    add(first, second, near || soon ? known.gap : gapOf(box, kInfinity), margin, near);
  }
  return true;
}

bool MapPairs::isNear(const Snapshot& snapshot, const Horizon& horizon, std::uint32_t first, std::uint32_t second) {
  const std::vector<std::uint32_t>& maps = snapshot.structure().maps;
  for (const bool swap : {false, true}) {
    const std::uint32_t map = swap ? second : first, body = swap ? first : second;
    const auto found = std::lower_bound(maps.begin(), maps.end(), map);
    if (found == maps.end() || *found != map) continue;
    OfMap& known = maps_[static_cast<std::size_t>(found - maps.begin())];
    if (!known.cells) continue;
    std::size_t room = 0;  // addShapes() returns false at the first pair, because there is no room for it
    if (!addShapes(known, map, body, snapshot, horizon, room, nullptr)) return true;
  }
  return false;
}

}  // namespace hgrid
