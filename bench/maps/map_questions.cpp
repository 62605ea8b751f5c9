// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#include "bench/maps/map_questions.h"

#include "bench/peers/radix_sort.h"
#include "bench/workload/random_points.h"

namespace hgrid {
namespace bench {
namespace {

constexpr double kRadius = 0.25, kNear = 0.5, kLength = 10.0;       // [m]
constexpr double kSmallestRadius = 0.03, kLargestRadius = 0.15;  // [m] of small spheres
constexpr double kSmallNear = 0.6;  // [m] largest distance of a small sphere from the middle of the leaf

bool isDoubtful(const StaticGrid& grid, const Sphere& sphere, MapQuestion kind) {
  const Sphere less{sphere.center, sphere.radius - MapDoubts::kDoubt},
      more{sphere.center, sphere.radius + MapDoubts::kDoubt};
  if (kind != MapQuestion::overlapping) return grid.touches(less) != grid.touches(more);
  std::vector<Voxel> of_less, of_more;
  grid.overlapping(less, grid.size(), of_less);
  grid.overlapping(more, grid.size(), of_more);
  return of_less != of_more;
}

bool isDoubtful(const StaticGrid& grid, const Segment& segment) {
  const auto first = [&](const Eigen::Vector3d& from, const Eigen::Vector3d& to) {
    const auto touch = grid.firstAlong({segment.from + from, segment.to + to, 0.0});
    return touch ? numberOf(touch->voxel) : ~std::uint64_t{0};
  };
  const Eigen::Vector3d none = Eigen::Vector3d::Zero();
  const std::uint64_t answer = first(none, none);
  const Eigen::Vector3d along = (segment.to - segment.from).normalized(), side = along.unitOrthogonal();
  for (const double by : {-MapDoubts::kDoubt, MapDoubts::kDoubt}) {
    for (const Eigen::Vector3d& aside : {side, Eigen::Vector3d(along.cross(side))}) {
      if (first(by * aside, by * aside) != answer) return true;
    }
    if (first(by * along, none) != answer || first(none, by * along) != answer) return true;
  }
  return false;
}

}  // namespace

MapQuestions::MapQuestions(const Map& map, std::size_t count) {
  Random random(4);
  for (std::size_t i = 0; i < count; ++i) {
    const Voxel& near = map.leaves[random.below(map.leaves.size())];
    const Eigen::Vector3d middle = 0.5 * (minCorner(near, map.resolution) + maxCorner(near, map.resolution));
    // Rounding to float gives peers that use float the same questions as peers that use double.
    const Eigen::Vector3f center = (middle + cubePoint(random, kNear)).cast<float>();
    const Eigen::Vector3f to = (center.cast<double>() + kLength * direction(random)).cast<float>();
    spheres.push_back({center.cast<double>(), kRadius});
    segments.push_back({center.cast<double>(), to.cast<double>(), 0.0});
    const Eigen::Vector3f beside = (middle + random.uniform(0.0, kSmallNear) * direction(random)).cast<float>();
    const auto radius = static_cast<float>(random.uniform(kSmallestRadius, kLargestRadius));
    small.push_back({beside.cast<double>(), static_cast<double>(radius)});
  }
}

std::vector<std::uint32_t> MapQuestions::inMortonOrder(double resolution) const {
  RadixSort sort;
  for (std::uint32_t i = 0; i < size(); ++i) {
    const Eigen::Vector3d at = inKeys(spheres[i].center, resolution);
    const Voxel cell{static_cast<std::uint16_t>(at.x()), static_cast<std::uint16_t>(at.y()),
                     static_cast<std::uint16_t>(at.z()), 0};
    sort.items().push_back({static_cast<std::uint32_t>(mortonOf(cell) >> 16), i});
  }
  std::vector<std::uint32_t> order;
  for (const RadixSort::Item& item : sort.sorted()) order.push_back(item.number);
  return order;
}

MapDoubts::MapDoubts(const StaticGrid& grid, const MapQuestions& questions, MapQuestion kind) {
  for (std::size_t i = 0; i < questions.size(); ++i) {
    doubts_.push_back(kind == MapQuestion::segment ? isDoubtful(grid, questions.segments[i])
                                                   : isDoubtful(grid, questions.spheresOf(kind)[i], kind));
    count_ += doubts_.back() ? 1 : 0;
  }
}

}  // namespace bench
}  // namespace hgrid
