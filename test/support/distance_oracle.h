// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

#include <limits>

#include "test/support/convex.h"

namespace hgrid {
namespace test {

/// Bounds between which the true value lies.
struct Interval {
  double lower = 0.0, upper = 0.0;
  double width() const { return upper - lower; }
  /// Returns how far `value` lies outside of the interval. The error of `value` is at least that much.
  double errorOf(double value) const { return value < lower ? lower - value : value > upper ? value - upper : 0.0; }
};

/// The distance of the cores of two convex sets (the sets without their radii), and the nearest points of the cores.
struct CoreDistance {
  Real lower = 0, upper = 0;  ///< [m] bounds of the distance of the cores
  Vector3r on_first = Vector3r::Zero(), on_second = Vector3r::Zero();
};

/// Computes the distance of the cores of two convex sets, independently of the product.
///
/// Minimizes |v| over all differences v of their points. v is the point of a simplex nearest to the origin. Each step
/// adds the difference that lies farthest in direction -v to the simplex (after Gilbert, Johnson, Keerthi, 1988).
/// Unlike the paper, it tries all faces of the simplex and uses extended precision. Each step proves two bounds:
/// - |v| is an upper bound, because it is the distance of two points of the sets.
/// - The plane through the new difference, perpendicular to v, is a lower bound, because no difference is nearer.
///
/// @param tolerance  [m] the search stops when the bounds are this close, or when the precision does not allow more
/// @param enough     [m] the search stops when the distance is proved to be greater than this
CoreDistance coreDistance(const Convex& first, const Convex& second, Real tolerance = 1e-11L,
                          Real enough = std::numeric_limits<Real>::infinity());

/// Returns bounds of the distance [m] of two convex sets, radii included; 0 if they overlap.
Interval distanceOf(const Convex& first, const Convex& second);

}  // namespace test
}  // namespace hgrid
