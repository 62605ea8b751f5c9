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

/// Queries of every kind in random order, each around a point near some box: balls of radius 1 (robots: 0.25), cubes
/// as wide, and segments of a fifth of the world's side in any direction; nearest asks from the balls' centres.
struct QuerySet {
  std::vector<Sphere> spheres;
  std::vector<Segment> segments;
  std::vector<Aabb> boxes;

  QuerySet(const std::string& workload, const World& world, std::size_t count);
  std::size_t size() const { return spheres.size(); }
};

}  // namespace bench
}  // namespace hgrid
