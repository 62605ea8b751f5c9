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

/// How many boxes a nearest query asks for.
inline std::size_t countOf(QueryKind kind) { return kind == QueryKind::nearest8 ? 8 : 1; }

/// Where queries are asked.
enum class Placed {
  near,      ///< around points near boxes; segments are a fifth of the world's side long
  anywhere,  ///< at random places in the bounds of all boxes, most of which are empty in many worlds
};

const char* name(Placed placed);

/// Queries of every kind in random order; nearest asks from the spheres' centers.
struct QuerySet {
  std::vector<Sphere> spheres;
  std::vector<Segment> segments;
  std::vector<Aabb> boxes;

  std::size_t size() const { return spheres.size(); }
};

/// Queries near boxes: spheres of radius 1 m (robots: 0.25 m), cubes as wide, and segments in any direction.
QuerySet queriesNear(const std::string& workload, const World& world, std::size_t count);

/// Queries anywhere, with about half a hit each if the world is not too empty; see sizesForEmptySpace().
QuerySet queriesAnywhere(const World& world, std::size_t count);

}  // namespace bench
}  // namespace hgrid
