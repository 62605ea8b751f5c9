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

/// Returns the number of boxes that a nearest query asks for.
inline std::size_t countOf(QueryKind kind) { return kind == QueryKind::nearest8 ? 8 : 1; }

/// Where the queries of a set are.
enum class Placed {
  near,      ///< at points near boxes; the length of segments is a fifth of the world's side
  anywhere,  ///< at random places in the bounds of all boxes; in many worlds most of this space is empty
};

const char* name(Placed placed);

/// Queries of every kind, in random order. Nearest queries start from the centers of the spheres.
struct QuerySet {
  std::vector<Sphere> spheres;
  std::vector<Segment> segments;
  std::vector<Aabb> boxes;

  std::size_t size() const { return spheres.size(); }
};

/// Returns queries near boxes: spheres of radius 1 m (workload robots: 0.25 m), cubes of the same width, and segments
/// in random directions.
QuerySet queriesNear(const std::string& workload, const World& world, std::size_t count);

/// Returns queries at random places. They have about half a hit each if the world is not too empty for that; see
/// sizesForEmptySpace().
QuerySet queriesAnywhere(const World& world, std::size_t count);

}  // namespace bench
}  // namespace hgrid
