// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

#include "test/support/distance_oracle.h"

namespace hgrid {
namespace test {

/// Returns bounds of the penetration depth [m] of two convex sets. The depth is the length of the shortest translation
/// that separates the sets; 0 if they are apart.
///
/// The Minkowski difference of the sets is the set of all differences of their points. The depth is the distance from
/// the origin to its surface. The function grows a polytope inside the Minkowski difference, always at the face that is
/// nearest to the origin. The distance to this face is the lower bound. The extent of the Minkowski difference along
/// the normal of this face is the upper bound (after van den Bergen, 2001). At the end the function checks that the
/// polytope is closed and convex. If the check fails, there is no lower bound.
/// @param enough  [m] the search stops when it has proved that the depth is greater than this
Interval depthOf(const Convex& first, const Convex& second, double enough = std::numeric_limits<double>::infinity());

}  // namespace test
}  // namespace hgrid
