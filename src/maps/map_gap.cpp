// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#include "maps/map_gap.h"

#include <limits>

#include "geometry/rounding.h"
#include "maps/distance_blocks.h"

namespace hgrid {

std::shared_ptr<const MapCells> makeMapCells(std::shared_ptr<const StaticGrid> grid, const NarrowPhase& narrow_phase,
                                             std::shared_ptr<const UnmappedSpace> unmapped, bool lasting) {
  auto cells = std::make_shared<MapCells>();
  for (std::size_t level = 0; level < cells->cubes.size(); ++level) {
    const double edge = std::ldexp(grid->finestEdge(), static_cast<int>(level));
    cells->cubes[level] = narrow_phase.block(Eigen::Vector3d::Constant(edge));
  }
  if (lasting) cells->distances = std::make_shared<const DistanceBlocks>(*grid);
  cells->grid = std::move(grid);
  cells->unmapped = std::move(unmapped);
  return cells;
}

Eigen::AlignedBox3d boxInMap(const Pose& map_from_world, const Aabb& box, const Eigen::Vector3d& origin) {
  const Eigen::Vector3d low = box.min.cast<double>(), high = box.max.cast<double>();
  const Eigen::Vector3d middle = origin + 0.5 * (low + high);
  const Eigen::Vector3d center = map_from_world * middle;
  const double rounding = gapRounding(middle.norm() + map_from_world.translation().norm() + (high - low).norm());
  const Eigen::Vector3d half = (map_from_world.linear().cwiseAbs() * (0.5 * (high - low))).array() + rounding;
  return {center - half, center + half};
}

double gapTo(const StaticGrid& grid, const Eigen::AlignedBox3d& box, double up_to) {
  double least = std::numeric_limits<double>::infinity();
  grid.visitNear(box, up_to + gapRounding(up_to), [&](const Voxel&, double distance) {
    least = std::min(least, distance - gapRounding(distance));
    return distance > 0.0 ? distance : kNoFurther;
  });
  return least;
}

}  // namespace hgrid
