// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

#include <vector>

#include "hgrid_proximity/geometry/aabb.h"

namespace hgrid {
namespace bench {

/// Returns the box around all boxes. There must be at least one box.
Aabb boundsOf(const std::vector<Aabb>& boxes);

/// Sizes of queries [m].
struct QuerySizes {
  double half_edge;  ///< half the edge of the cubes
  double radius;     ///< radius of the spheres
  double length;     ///< length of the segments
};

/// Returns sizes with which queries at random places in the bounds of the boxes have 0.4 .. 0.9 hits on average.
///
/// If most of this space is empty, such queries would be as large as a whole group of boxes. Therefore cubes and
/// spheres are at most a few boxes wide, and segments are at most a fifth of the bounds long. They then have fewer
/// hits.
QuerySizes sizesForEmptySpace(const std::vector<Aabb>& boxes);

}  // namespace bench
}  // namespace hgrid
