// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <vector>

namespace hgrid {

/// Splits a polygon of at least 3 corners into triangles that cover exactly its area, whatever its form. Their sides
/// within the polygon join two of its corners. So the triangles of faces that share a side meet in that side. Takes
/// O(n^2), rarely O(n^3) time.
///
/// - A polygon may touch itself, for instance where two coinciding sides lead to a hole.
/// - If sides cross each other, the triangles cover at least each point around which the polygon winds.
/// - A polygon that is not flat has no area of its own. It is split in its projection along the axis that is nearest to
///   its normal. Then sides within it are replaced by other diagonals as long as that moves the surface toward the
///   normal. So if the projection is convex, no other way to split the polygon encloses more.
///
/// @returns numbers of corners, three for each triangle; they turn in the same direction as the polygon
std::vector<std::array<std::uint32_t, 3>> splitPolygon(const std::vector<Eigen::Vector3f>& corners);

}  // namespace hgrid
