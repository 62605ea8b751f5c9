// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

#include <limits>

#include "test/support/convex.h"

namespace hgrid {
namespace test {

/// Bounds of a number that is not known exactly.
struct Interval {
  double lower = 0.0, upper = 0.0;
  double width() const { return upper - lower; }
  /// Returns how far `value` is outside of the interval. The error of `value` is at least this large.
  double errorOf(double value) const { return value < lower ? lower - value : value > upper ? value - upper : 0.0; }
};

/// The distance of the cores of two convex sets (see Convex), and the nearest points of the cores.
struct CoreDistance {
  Real lower = 0, upper = 0;  ///< [m] bounds of the distance of the cores
  Vector3r on_first = Vector3r::Zero(), on_second = Vector3r::Zero();
};

/// Computes the distance of the cores of two convex sets, independently of the product.
///
/// A difference is a point of the first core minus a point of the second core. The function minimizes |v|, where v is
/// the point nearest to the origin in a simplex of differences. Each step adds the difference that is farthest in
/// direction -v to the simplex (after Gilbert, Johnson, Keerthi, 1988). Unlike the paper, the function tries all faces
/// of the simplex and uses extended precision. Each step proves two bounds:
/// - |v| is an upper bound, because it is the distance of two points of the cores.
/// - The distance from the origin to the plane through the new difference, perpendicular to v, is a lower bound. No
///   difference lies between the origin and this plane.
///
/// @param tolerance  [m] the search stops when the bounds differ by less, or when the precision allows no progress
/// @param enough     [m] the search stops when it has proved that the distance is greater than this
CoreDistance coreDistance(const Convex& first, const Convex& second, Real tolerance = 1e-11L,
                          Real enough = std::numeric_limits<Real>::infinity());

/// Returns bounds of the distance [m] of two convex sets, including their radii; 0 if they overlap.
Interval distanceOf(const Convex& first, const Convex& second);

}  // namespace test
}  // namespace hgrid
