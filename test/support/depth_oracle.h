// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

#include "test/support/distance_oracle.h"

namespace hgrid {
namespace test {

/// Returns bounds of the penetration depth [m] of two convex sets. The depth is the length of the shortest move that
/// separates them, and 0 if they are apart.
///
/// The depth is the distance from the origin to the surface of the Minkowski difference, which is the set of all
/// differences of their points. The function grows a polytope inside that set, always at the face nearest to the
/// origin. The distance to that face is the lower bound. The extent of the set along the normal of that face is the
/// upper bound (after van den Bergen, 2001). At the end the function checks that the polytope is closed and convex. If
/// it is not, the polytope gives no lower bound.
/// @param enough  [m] the search stops when the depth is proved to be greater than this
Interval depthOf(const Convex& first, const Convex& second, double enough = std::numeric_limits<double>::infinity());

}  // namespace test
}  // namespace hgrid
