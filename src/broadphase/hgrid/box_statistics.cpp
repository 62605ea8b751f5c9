// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#include "broadphase/hgrid/box_statistics.h"

#include <algorithm>
#include <cstdint>
#include <cstring>

#include "geometry/infinity.h"

namespace hgrid {
namespace {

/// Returns the smallest k >= 0 for which `ratio` is at most GridScale::kRatio^k, but not more than GridScale::kLevels.
/// Computes k from the exponent of `ratio`. A loop over the size classes would be slower, because the processor would
/// mispredict its end if the sizes of boxes differ.
/// @param ratio  at least 0; may be infinite
std::size_t sizeClassOf(float ratio) {
  static_assert(GridScale::kRatio == 4.0, "a size class spans two powers of 2");
  std::uint32_t bits;
  std::memcpy(&bits, &ratio, sizeof bits);
  const int exponent = static_cast<int>((bits + 0x7fffffu) >> 23) - 127;  // of the smallest power of 2 >= ratio
  return static_cast<std::size_t>(std::clamp((exponent + 1) / 2, 0, GridScale::kLevels));
}

}  // namespace

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
  const auto per_edge = static_cast<float>(1.0 / finest_edge);  // exact: the edge is a power of 2
  for (std::size_t k = 0; k < count; ++k) {
    const Aabb& box = boxes[ids[k]];
    const Eigen::Vector3f size = box.max - box.min;
    const std::size_t number = sizeClassOf(size.maxCoeff() * per_edge);
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
