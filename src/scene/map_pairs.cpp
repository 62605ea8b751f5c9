// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#include "scene/map_pairs.h"

#include <algorithm>
#include <limits>

#include "scene/map_gap.h"
#include "scene/pair_margin.h"

namespace hgrid {

/// Forgets the gaps to maps that moved or that have other cells.
void MapPairs::recall(const Snapshot& snapshot) {
  const Structure& structure = snapshot.structure();
  if (revision_ != structure.revision) maps_.clear();  // proxies have other numbers
  revision_ = structure.revision;
  maps_.resize(structure.maps.size());
  for (std::size_t i = 0; i < maps_.size(); ++i) {
    OfMap& map = maps_[i];
    const Pose& pose = snapshot.poses()[structure.maps[i]].world_from_body;
    const std::shared_ptr<const MapCells> cells = snapshot.cellsOf(structure.maps[i]);
    map.map_from_world_before = map.map_from_world;
    if (map.cells == cells && map.world_from_map.matrix() == pose.matrix()) continue;
    map.world_from_map = pose;
    map.map_from_world = pose.inverse();
    if (!map.cells) map.map_from_world_before = map.map_from_world;
    map.cells = cells;
    map.gaps.assign(structure.body_of_proxy.size(), Gap{});
  }
}

void MapPairs::find(const Snapshot& snapshot, const Horizon& horizon, const Add& add) {
  recall(snapshot);
  const std::vector<std::uint32_t>& numbers = snapshot.structure().maps;
  for (std::size_t i = 0; i < maps_.size(); ++i) {
    const bool placed = snapshot.poses()[numbers[i]].state != Freshness::unplaced;
    if (placed && maps_[i].cells) findFor(maps_[i], numbers[i], snapshot, horizon, add);
  }
}

/// Whether a box came within the margin of a cell between the last tick and this one, as seen from the map.
bool MapPairs::passed(const OfMap& map, ProxyId proxy, const Snapshot& snapshot, const Horizon& horizon,
                      double margin) const {
  const Aabb &from = horizon.before(proxy), &to = snapshot.boxes()[proxy];
  if (from == to && map.map_from_world_before.matrix() == map.map_from_world.matrix()) return false;
  const Eigen::AlignedBox3d swept = boxInMap(map.map_from_world_before, from, snapshot.origin())
                                        .merged(boxInMap(map.map_from_world, to, snapshot.origin()));
  return gapTo(*map.cells->grid, swept, margin) <= margin;
}

void MapPairs::findFor(OfMap& map, std::uint32_t number, const Snapshot& snapshot, const Horizon& horizon,
                       const Add& add) {
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  const Structure& structure = snapshot.structure();
  const auto gapOf = [&](const Aabb& box, double up_to) {
    return gapTo(*map.cells->grid, boxInMap(map.map_from_world, box, snapshot.origin()), up_to);
  };
  const Staleness staleness = stalenessOf(snapshot.poses()[number]);
  const double map_can_go = horizon.reachOf(number);
  for (std::uint32_t body = 0; body < structure.bodies.size(); ++body) {
    if (snapshot.poses()[body].state == Freshness::unplaced || structure.filter.allowed(body, number)) continue;
    const std::uint32_t first = std::min(body, number), second = std::max(body, number);
    const double margin = pairMargin(structure, body, stalenessOf(snapshot.poses()[body]), number, staleness);
    const double can_go = map_can_go + horizon.reachOf(body), up_to = std::max(margin, can_go);
    for (ProxyId proxy = structure.first_proxy[body]; proxy < structure.first_proxy[body + 1]; ++proxy) {
      const Aabb& box = snapshot.boxes()[proxy];
      Gap& known = map.gaps[proxy];
      if (known.up_to < up_to || known.box != box) known = {box, up_to, gapOf(box, up_to)};
      if (known.gap <= margin) {
        add(first, second, known.gap, margin, true);
      } else if (known.gap <= can_go) {
        add(first, second, known.gap, margin, false);
      } else if (horizon.on() && passed(map, proxy, snapshot, horizon, margin)) {
        add(first, second, gapOf(box, kInfinity), margin, false);
      }
    }
  }
}

}  // namespace hgrid
