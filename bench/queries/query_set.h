// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

#include <string>
#include <vector>

#include "bench/workload/world.h"

namespace hgrid {
namespace bench {

enum class QueryKind { sphere, segment, box, nearest, nearest8 };
constexpr QueryKind kQueryKinds[] = {QueryKind::sphere, QueryKind::segment, QueryKind::box, QueryKind::nearest,
                                     QueryKind::nearest8};

const char* name(QueryKind kind);

/// Returns how many boxes a nearest query asks for.
inline std::size_t countOf(QueryKind kind) { return kind == QueryKind::nearest8 ? 8 : 1; }

/// Selects the places of the queries.
enum class Placed {
  near,      ///< at points near boxes; segments are a fifth of the world's side long
  anywhere,  ///< at random places in the bounds of all boxes, which in many worlds are mostly empty
};

const char* name(Placed placed);

/// Queries of every kind, in random order. Nearest queries start from the centers of the spheres.
struct QuerySet {
  std::vector<Sphere> spheres;
  std::vector<Segment> segments;
  std::vector<Aabb> boxes;

  std::size_t size() const { return spheres.size(); }
};

/// Returns queries near boxes: spheres of radius 1 m (0.25 m in the workload robots), cubes whose edge is the diameter
/// of the spheres, and segments in random directions.
QuerySet queriesNear(const std::string& workload, const World& world, std::size_t count);

/// Returns queries at random places. On average each has about half a hit, or fewer if the world is too empty, see
/// sizesForEmptySpace().
QuerySet queriesAnywhere(const World& world, std::size_t count);

}  // namespace bench
}  // namespace hgrid
