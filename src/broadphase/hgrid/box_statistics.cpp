// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#include "broadphase/hgrid/box_statistics.h"

#include <algorithm>
#include <cstdint>
#include <cstring>

#include "geometry/four_lanes.h"
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

/// Sums of the sides of boxes. The fourth numbers are those of a side that is 1 m long for each box.
struct Sum {
  Four largest{};     // [m]
  double total[4]{};  // [m] the fourth is the number of boxes

  void add(Four sides) {
    largest = greatest(largest, sides);
    for (int i = 0; i < 4; ++i) total[i] += static_cast<double>(sides[i]);
  }
  Census census() const { return {total[3], {largest[0], largest[1], largest[2]}, {total[0], total[1], total[2]}}; }
};

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
  // Boxes are added to the first and to the second sums in turn. Otherwise each addition would wait for the one before,
  // because successive boxes are often of the same size.
  std::array<std::array<Sum, BoxStatistics::kSizes>, 2> sums;
  Four lower = allFour(kFloatInfinity), upper = allFour(-kFloatInfinity);
  const auto per_edge = static_cast<float>(1.0 / finest_edge);  // exact: the edge is a power of 2
  for (std::size_t k = 0; k < count; ++k) {
    const Aabb& box = boxes[ids[k]];
    const Four corner{box.min[0], box.min[1], box.min[2], 0.0f};
    const Four sides = least(Four{box.max[0], box.max[1], box.max[2], 1.0f} - corner, allFour(kernels::kMostFloat));
    lower = least(lower, corner);
    upper = greatest(upper, corner);
    sums[k % 2][sizeClassOf(std::max(std::max(sides[0], sides[1]), sides[2]) * per_edge)].add(sides);
    if (shapes == Shapes::counted) {
      statistics.shapes[shapeOf({sides[0], sides[1], sides[2]})].add(Census::Vector{sides[0], sides[1], sides[2]});
    }
  }
  for (std::size_t size = 0; size < BoxStatistics::kSizes; ++size) {
    statistics.sizes[size] = sums[0][size].census();
    statistics.sizes[size].add(sums[1][size].census());
  }
  for (std::size_t i = 0; i < 3; ++i) {
    statistics.lower[i] = lower[i];
    statistics.upper[i] = upper[i];
  }
  return statistics;
}

}  // namespace hgrid
