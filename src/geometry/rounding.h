// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

namespace hgrid {

// Bounds of rounding errors that many files need. doc/tolerances.md lists these and all others.

/// Returns a bound [m] of the rounding errors of a distance that is computed in doubles.
/// @param size  [m] sum of the lengths from which the distance is computed
constexpr double gapRounding(double size) { return 1e-14 * size; }

/// Bound of the rounding errors of a point whose coordinates become floats, relative to the sum of these coordinates.
constexpr double kFloatRounding = 4e-7;
/// [m] Bound of the same near 0, where floats have fewer digits.
constexpr double kFloatRoundingNearZero = 1e-37;

/// [m] Lengths by which something is divided are at least this. No float that is smaller matters.
constexpr double kLeastLength = 1e-30;
/// [m] A line that moves by less than this along an axis counts as perpendicular to the axis. Quotients by larger
/// numbers do not overflow.
constexpr double kLeastStep = 1e-100;

}  // namespace hgrid
