// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#include "bench/queries/query_set.h"

#include "bench/queries/query_sizes.h"
#include "bench/workload/random_points.h"

namespace hgrid {
namespace bench {

const char* name(QueryKind kind) {
  static constexpr const char* kNames[] = {"sphere", "segment", "box", "nearest", "nearest8"};
  return kNames[static_cast<int>(kind)];
}

const char* name(Placed placed) { return placed == Placed::near ? "near" : "anywhere"; }

// Queries are rounded to float. Then peers that use float get the same queries as peers that use double.

QuerySet queriesNear(const std::string& workload, const World& world, std::size_t count) {
  const double radius = workload == "robots" ? 0.25 : 1.0;
  QuerySet queries;
  Random random(3);
  for (std::size_t i = 0; i < count; ++i) {
    const Aabb& near = world.boxes()[random.below(world.boxes().size())];
    const Eigen::Vector3f center =
        (0.5 * (near.min + near.max).cast<double>() + cubePoint(random, radius)).cast<float>();
    const Eigen::Vector3f half = Eigen::Vector3f::Constant(static_cast<float>(radius));
    const Eigen::Vector3f to = (center.cast<double>() + 0.2 * world.side() * direction(random)).cast<float>();
    queries.spheres.push_back({center.cast<double>(), radius});
    queries.segments.push_back({center.cast<double>(), to.cast<double>(), 0.0});
    queries.boxes.push_back({center - half, center + half});
  }
  return queries;
}

QuerySet queriesAnywhere(const World& world, std::size_t count) {
  const Aabb bounds = boundsOf(world.boxes());
  const QuerySizes sizes = sizesForEmptySpace(world.boxes());
  const Eigen::Vector3f half = Eigen::Vector3f::Constant(static_cast<float>(sizes.half_edge));
  QuerySet queries;
  Random random(5);
  for (std::size_t i = 0; i < count; ++i) {
    const Eigen::Vector3f center = randomPoint(random, {bounds.min, bounds.max});
    const Eigen::Vector3d step = 0.5 * sizes.length * direction(random);
    const Eigen::Vector3f from = (center.cast<double>() - step).cast<float>();
    const Eigen::Vector3f to = (center.cast<double>() + step).cast<float>();
    queries.spheres.push_back({center.cast<double>(), sizes.radius});
    queries.segments.push_back({from.cast<double>(), to.cast<double>(), 0.0});
    queries.boxes.push_back({center - half, center + half});
  }
  return queries;
}

}  // namespace bench
}  // namespace hgrid
