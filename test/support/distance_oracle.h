// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

#include <limits>

#include "test/support/convex.h"

namespace hgrid {
namespace test {

/// Between these the true value lies; the witness never claims to know more.
struct Interval {
  double lower = 0.0, upper = 0.0;
  double width() const { return upper - lower; }
  /// How far `value` lies outside: the least error it has.
  double errorOf(double value) const { return value < lower ? lower - value : value > upper ? value - upper : 0.0; }
};

/// The distance [m] of two convex sets and where it is: points of the cores, without the radii.
struct CoreDistance {
  Real lower = 0, upper = 0;  ///< of the cores
  Vector3r on_first = Vector3r::Zero(), on_second = Vector3r::Zero();
};

/// The distance of the cores of two convex sets, an independent witness.
///
/// Minimises |v| over the differences v of their points: v is the nearest point of a simplex that the farthest
/// difference against v joins in every step (after Gilbert, Johnson, Keerthi, 1988; all faces of the simplex are
/// tried, in extended precision). Every step proves a bound of each side: |v| is the distance of two points, and no
/// difference lies nearer than the plane through the farthest one across v.
///
/// @param tolerance  [m] stops when the bounds are this close; or when extended precision gives no more
/// @param enough     [m] stops when the distance is proved to be more
CoreDistance coreDistance(const Convex& first, const Convex& second, Real tolerance = 1e-11L,
                          Real enough = std::numeric_limits<Real>::infinity());

/// The distance of two convex sets with their radii; 0 if they overlap.
Interval distanceOf(const Convex& first, const Convex& second);

}  // namespace test
}  // namespace hgrid
