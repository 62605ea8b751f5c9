// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#include "broadphase/hgrid/box_statistics.h"

#include <algorithm>

#include "geometry/infinity.h"

namespace hgrid {

Census BoxStatistics::all() const {
  Census all;
  for (const Census& size : sizes) all.add(size);
  return all;
}

BoxStatistics statisticsOf(const std::vector<Aabb>& boxes, const ProxyId* ids, std::size_t count, double finest_edge,
                           Shapes shapes) {
  BoxStatistics statistics;
  statistics.boxes = count;
  statistics.finest_edge = finest_edge;
  Census::Vector &lower = statistics.lower, &upper = statistics.upper;
  lower.fill(kInfinity);
  upper.fill(-kInfinity);
  for (std::size_t k = 0; k < count; ++k) {
    const Aabb& box = boxes[ids[k]];
    const Eigen::Vector3f size = box.max - box.min;
    double edge = finest_edge;
    std::size_t number = 0;
    for (const double side = size.maxCoeff(); number < GridScale::kLevels && side > edge; ++number) {
      edge *= GridScale::kRatio;
    }
    Census::Vector sides;
    for (std::size_t i = 0; i < 3; ++i) {
      const double low = box.min[static_cast<Eigen::Index>(i)];
      sides[i] = box.max[static_cast<Eigen::Index>(i)] - low;
      lower[i] = std::min(lower[i], low);
      upper[i] = std::max(upper[i], low);
    }
    statistics.sizes[number].add(sides);
    if (shapes == Shapes::counted) statistics.shapes[shapeOf({size[0], size[1], size[2]})].add(sides);
  }
  return statistics;
}

}  // namespace hgrid
