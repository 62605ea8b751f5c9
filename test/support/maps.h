// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

#include <algorithm>

#include "hgrid_proximity/maps/map_cells.h"
#include "test/support/random.h"
#include "test/support/scenes.h"

namespace hgrid {
namespace test {

inline Body mapBody(const std::string& name, Mobility mobility = Mobility::fixed) {
  Body body;
  body.name = "map/" + name;
  body.frame = "world";
  body.kind = BodyKind::map;
  body.mobility = mobility;
  body.max_speed = mobility == Mobility::fixed ? 0.0 : 1.0;
  return body;
}

/// Returns map cells that have only a grid, no cubes. A narrow phase needs the cubes, so it cannot measure these cells.
inline std::shared_ptr<const MapCells> cellsOf(double edge, const std::vector<Voxel>& voxels) {
  auto cells = std::make_shared<MapCells>();
  cells->grid = std::make_shared<StaticGrid>(edge, voxels);
  return cells;
}

/// Returns random cells of a map, in Morton order. They are disjoint, and each is a leaf of level 0 or 1.
/// @param far  greatest difference between a key of a cell and the key of the map's origin
inline std::vector<Voxel> randomVoxels(Random& random, int count, int far) {
  std::vector<Voxel> voxels;
  const auto key = [&](int step) {
    return static_cast<std::uint16_t>(Voxel::kOriginKey + random.between(-far / step, far / step) * step);
  };
  for (int i = 0; i < count; ++i) {
    const int level = random.below(2), step = 1 << level;
    voxels.push_back({key(step), key(step), key(step), static_cast<std::uint8_t>(level)});
  }
  std::sort(voxels.begin(), voxels.end(), [](const Voxel& a, const Voxel& b) {
    return mortonOf(a) != mortonOf(b) ? mortonOf(a) < mortonOf(b) : a.level > b.level;
  });
  std::vector<Voxel> disjoint;
  std::uint64_t end = 0;
  for (const Voxel& voxel : voxels) {
    if (mortonOf(voxel) < end) continue;
    disjoint.push_back(voxel);
    end = mortonOf(voxel) + (std::uint64_t{1} << 3 * voxel.level);
  }
  return disjoint;
}

/// Returns the gap [m] between a cell of a map and a box, computed as the documentation defines it: the distance
/// between the cell and the bounding box of `box` in the frame of the map.
inline double gapByHand(const Snapshot& snapshot, std::uint32_t map, const Voxel& voxel, double edge, const Aabb& box) {
  const Pose map_from_world = snapshot.poses()[map].world_from_body.inverse();
  Eigen::Vector3d low = Eigen::Vector3d::Constant(1e300), high = -low;
  for (int corner = 0; corner < 8; ++corner) {
    Eigen::Vector3d at;
    for (int axis = 0; axis < 3; ++axis) at[axis] = corner >> axis & 1 ? box.max[axis] : box.min[axis];
    const Eigen::Vector3d in_map = map_from_world * (snapshot.origin() + at);
    low = low.cwiseMin(in_map);
    high = high.cwiseMax(in_map);
  }
  const Eigen::Vector3d gap =
      (minCorner(voxel, edge) - high).cwiseMax(low - maxCorner(voxel, edge)).cwiseMax(Eigen::Vector3d::Zero());
  return gap.norm();
}

}  // namespace test
}  // namespace hgrid
