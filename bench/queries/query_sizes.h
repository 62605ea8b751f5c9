// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

#include <vector>

#include "hgrid_proximity/geometry/aabb.h"

namespace hgrid {
namespace bench {

/// The box around all boxes; there must be one at least.
Aabb boundsOf(const std::vector<Aabb>& boxes);

/// Sizes of queries [m].
struct QuerySizes {
  double half_edge;  ///< of cubes
  double radius;     ///< of spheres
  double length;     ///< of segments
};

/// Sizes with which queries at random places in the bounds of the boxes have 0.4 .. 0.9 hits each on average.
///
/// Where most of the bounds is empty, such queries would be as large as whole heaps of boxes. So cubes and spheres are
/// at most a few boxes wide, and segments at most a fifth of the bounds long. They then have fewer hits.
QuerySizes sizesForEmptySpace(const std::vector<Aabb>& boxes);

}  // namespace bench
}  // namespace hgrid
