// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#include "bench/queries/query_set.h"

#include "bench/workload/random_points.h"

namespace hgrid {
namespace bench {

const char* name(QueryKind kind) {
  static constexpr const char* kNames[] = {"sphere", "segment", "box", "nearest", "nearest8"};
  return kNames[static_cast<int>(kind)];
}

QuerySet::QuerySet(const std::string& workload, const World& world, std::size_t count) {
  const double radius = workload == "robots" ? 0.25 : 1.0;
  Random random(3);
  for (std::size_t i = 0; i < count; ++i) {
    const Aabb& near = world.boxes()[random.below(world.boxes().size())];
    // Rounded to float, so that peers in float are asked the same as those in double.
    const Eigen::Vector3f center =
        (0.5 * (near.min + near.max).cast<double>() + cubePoint(random, radius)).cast<float>();
    const Eigen::Vector3f half = Eigen::Vector3f::Constant(static_cast<float>(radius));
    const Eigen::Vector3f to = (center.cast<double>() + 0.2 * world.side() * direction(random)).cast<float>();
    spheres.push_back({center.cast<double>(), radius});
    segments.push_back({center.cast<double>(), to.cast<double>(), 0.0});
    boxes.push_back({center - half, center + half});
  }
}

}  // namespace bench
}  // namespace hgrid
