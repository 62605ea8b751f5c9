// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

#include "narrow/gjk.h"

namespace hgrid {

/// How deep two convex cores overlap, in the frame of the first core.
struct Overlap {
  /// Unit vector: moving the second core along it by `depth` separates the two.
  Eigen::Vector3d normal = Eigen::Vector3d::UnitX();
  double depth = std::numeric_limits<double>::infinity();  ///< [m] proved upper bound of the shortest separating move
  double at_least = 0.0;                                   ///< [m] lower bound of the same
};

/// Computes lower and upper bounds of the shortest move that separates two convex cores that meet (van den Bergen 2001,
/// the expanding polytope algorithm).
///
/// Like those of gapOf(), the bounds differ by at most 1e-10 m, or by twice gapRounding() if that is more. They differ
/// by more if a curved core or a hull needs more than kMostOverlapCorners corners of the difference of the cores.
Overlap overlapOf(const ConvexCore& first, const ConvexCore& second, const Pose& first_from_second);

constexpr std::size_t kMostOverlapCorners = 192;  ///< largest number of corners of the polytope

}  // namespace hgrid
