// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

#include <array>

#include "hgrid_proximity/geometry/pose.h"
#include "hgrid_proximity/geometry/shape.h"
#include "test/support/convex.h"

namespace hgrid {
namespace test {

using Triangle3r = std::array<Vector3r, 3>;

/// Computes the distance [m] of two triangles in extended precision, without cases: it minimizes the distance of two
/// mixes of the corners over the faces of the two triangles. Degenerate triangles are segments or points. 0: they meet.
Real triangleDistance(const Triangle3r& first, const Triangle3r& second);

/// Returns the distance [m] of the surfaces of two meshes: the least distance of all pairs of triangles.
double bruteForceDistance(const TriangleMesh& first, const TriangleMesh& second, const Pose& first_from_second);

/// Returns the winding number of a mesh around a point: the sum over all triangles, in extended precision.
double bruteForceWindingNumber(const TriangleMesh& mesh, const Eigen::Vector3d& point);

}  // namespace test
}  // namespace hgrid
