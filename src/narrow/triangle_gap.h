// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

#include <Eigen/Core>
#include <array>

#include "narrow/gjk.h"

namespace hgrid {

/// The three corners of a triangle [m]. They may lie on a line or coincide.
using Triangle = std::array<Eigen::Vector3d, 3>;

/// Computes the distance of two triangles that are given in the same frame.
///
/// The nearest points of two triangles are on two edges, or one is a corner or an edge of one triangle and the other is
/// inside the other triangle. The function tries these cases. It ends early if the nearest points of two edges prove
/// the distance (Larsen, Gottschalk, Lin, Manocha 1999, "Fast Proximity Queries with Swept Sphere Volumes").
///
/// Both bounds are proved: the upper one by two points of the triangles, the lower one by a plane between them. Where
/// doubles do not suffice for this, as for needles that cross at a small angle, gapOf() computes the gap.
/// @param size  [m] no corner is farther from the origin or from another corner than this
/// @returns a gap as that of gapOf(); infinite if the distance is proved to be at least GapLimits::enough
CoreGap gapOfTriangles(const Triangle& first, const Triangle& second, double size, const GapLimits& limits);

}  // namespace hgrid
