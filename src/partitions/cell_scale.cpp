// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#include "partitions/cell_scale.h"

#include <array>

namespace hgrid {
namespace book {
namespace {

constexpr double kSmallest = 0x1p-60, kLargest = 0x1p100;  // [m] reciprocals and products of such edges are finite

/// Returns the edge [m] of n equal cubes that together fill the bounds of the n boxes. An axis on which the world is
/// thinner than such a cube does not count. So n boxes on a floor get sqrt(n) cells per axis.
double edgeByDensity(const std::vector<Aabb>& boxes) {
  Aabb bounds = boxes.front();
  for (const Aabb& box : boxes) {
    bounds.min = bounds.min.cwiseMin(box.min);
    bounds.max = bounds.max.cwiseMax(box.max);
  }
  const Eigen::Vector3d size = bounds.max.cast<double>() - bounds.min.cast<double>();
  std::array<double, 3> side{size.x(), size.y(), size.z()};
  std::sort(side.begin(), side.end());
  const auto count = static_cast<double>(boxes.size());
  const double in_space = std::cbrt(side[0] * side[1] * side[2] / count);
  if (side[0] >= in_space && in_space > 0.0) return in_space;
  const double in_plane = std::sqrt(side[1] * side[2] / count);
  return side[1] >= in_plane && in_plane > 0.0 ? in_plane : side[2] / count;
}

}  // namespace

double cellEdgeFor(const std::vector<Aabb>& boxes, CellRule rule) {
  if (boxes.empty()) return 1.0;
  double edge = 0.0;
  if (rule == CellRule::objects) {
    std::vector<double> sides;
    sides.reserve(boxes.size());
    for (const Aabb& box : boxes) sides.push_back(longestSideInDouble(box));
    const auto longest_of_most = sides.begin() + static_cast<std::ptrdiff_t>((sides.size() - 1) * 19 / 20);
    std::nth_element(sides.begin(), longest_of_most, sides.end());
    edge = *longest_of_most;
  }
  if (!(edge > 0.0)) edge = edgeByDensity(boxes);
  return edge > 0.0 ? std::clamp(edge, kSmallest, kLargest) : 1.0;
}

}  // namespace book
}  // namespace hgrid
