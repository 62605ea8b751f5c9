// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#include "node/markers/map_markers.h"

#include <algorithm>
#include <array>
#include <iterator>

#include "node/markers/marker_parts.h"
#include "node/messages/to_messages.h"

namespace hgrid {
namespace {

using visualization_msgs::Marker;

/// Returns the occupied cells of a map that are near the box of a body, in Morton order, each once.
/// @param within  [m] cells at most this far from a sphere around the box are returned
/// @param most    largest number of cells
std::vector<Voxel> voxelsNearBodies(const Snapshot& snapshot, std::uint32_t map, const StaticGrid& grid, double within,
                                    std::size_t most) {
  const Pose map_from_world = snapshot.poses()[map].world_from_body.inverse();
  std::vector<Voxel> all, found;
  for (ProxyId proxy = 0; proxy < snapshot.boxes().size() && all.size() < most; ++proxy) {
    if (snapshot.poses()[snapshot.structure().body_of_proxy[proxy]].state == Freshness::unplaced) continue;
    if (snapshot.structure().isPlane(proxy)) continue;  // it has no box
    const Aabb& box = snapshot.boxes()[proxy];
    const Eigen::Vector3d low = box.min.cast<double>(), high = box.max.cast<double>();
    const Eigen::Vector3d center = map_from_world * (snapshot.origin() + 0.5 * (low + high));
    grid.overlapping(Sphere{center, 0.5 * (high - low).norm() + within}, most, found);
    std::vector<Voxel> both;  // the cells of `all` and `found`, each once
    std::set_union(all.begin(), all.end(), found.begin(), found.end(), std::back_inserter(both),
                   [](const Voxel& a, const Voxel& b) { return mortonOf(a) < mortonOf(b); });
    all.swap(both);
  }
  if (all.size() > most) all.resize(most);
  return all;
}

Marker cubes(const Tick& tick, std::uint32_t map, int id, double edge) {
  const BodyPose& pose = tick.snapshot->poses()[map];
  Marker marker = markerOf(tick, "maps", id, Marker::CUBE_LIST);
  marker.action = Marker::ADD;
  marker.pose = toPose(pose.world_from_body);
  marker.scale.x = marker.scale.y = marker.scale.z = edge;
  marker.color = colorOfBody(tick.snapshot->structure().bodies[map].kind, pose.state, std::nullopt);
  return marker;
}

}  // namespace

std::vector<Marker> mapMarkers(const Tick& tick, const Params& params) {
  std::vector<Marker> markers;
  if (!tick.snapshot || params.map_shown_within == 0.0) return markers;
  const Snapshot& snapshot = *tick.snapshot;
  std::size_t left = static_cast<std::size_t>(params.map_max_shown);
  for (std::size_t i = 0; i < snapshot.structure().maps.size(); ++i) {
    const std::uint32_t map = snapshot.structure().maps[i];
    const auto cells = snapshot.cellsOf(map);
    if (!cells || snapshot.poses()[map].state == Freshness::unplaced) continue;
    const StaticGrid& grid = *cells->grid;
    const std::vector<Voxel> voxels = voxelsNearBodies(snapshot, map, grid, params.map_shown_within, left);
    left -= std::min(left, voxels.size());
    std::array<std::vector<geometry_msgs::Point>, Voxel::kLevels + 1> centers;
    for (const Voxel& voxel : voxels) centers[voxel.level].push_back(toPoint(cells->centerOf(voxel)));
    for (std::size_t level = 0; level < centers.size(); ++level) {
      if (centers[level].empty()) continue;
      const double edge = std::ldexp(grid.finestEdge(), static_cast<int>(level));
      markers.push_back(cubes(tick, map, static_cast<int>(i * centers.size() + level), edge));
      markers.back().points = std::move(centers[level]);
    }
  }
  return markers;
}

}  // namespace hgrid
