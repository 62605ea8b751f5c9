// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

#include "test/support/distance_oracle.h"

namespace hgrid {
namespace test {

/// How deep [m] two convex sets overlap: the shortest way that frees one of the other; 0 if they are apart.
///
/// That is how deep zero lies in the set of the differences of their points. A polytope of such differences grows
/// from inside, always where zero lies least deep in it; its faces are the lower bound, the set's extent across
/// them the upper one (after van den Bergen, 2001). In the end the polytope is checked to be closed and convex; if it
/// is not, nothing is known from below.
/// @param enough  [m] stops when the depth is proved to be more
Interval depthOf(const Convex& first, const Convex& second, double enough = std::numeric_limits<double>::infinity());

}  // namespace test
}  // namespace hgrid
