// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

#include <memory>

#include "hgrid_proximity/geometry/shape.h"
#include "test/support/random.h"

namespace hgrid {
namespace test {

/// Limits for the dimensions of random solids.
struct Proportions {
  double smallest = 0.01;    ///< [m] least value of the longest dimension
  double largest = 2.0;      ///< [m] greatest value of the longest dimension
  double max_aspect = 50.0;  ///< greatest ratio of the longest to the shortest dimension
};

/// Returns the closed mesh of a box around the origin. All its triangles face outward (counter-clockwise).
TriangleMesh boxMesh(const Eigen::Vector3d& size);

/// Returns a closed mesh: a box without its top, open towards z, whose walls and floor are `wall` [m] thick. Its center
/// is that of the box.
TriangleMesh trayMesh(const Eigen::Vector3d& size, double wall);
/// Returns the closed mesh of a sphere of radius 1 m around the origin. It has 20 triangles. Each division divides each
/// triangle into four.
TriangleMesh ballMesh(int divisions);
/// Returns a closed mesh of 20 or 80 triangles. It is a sphere whose corners are moved to 0.5 .. 1 of the radius,
/// scaled to `size`. It is seldom convex, and it never intersects itself.
TriangleMesh lumpMesh(Random& random, const Eigen::Vector3d& size);

/// Returns a mesh with the same surface, in the form of an STL file: triangles do not share corners.
TriangleMesh unwelded(const TriangleMesh& mesh);
/// Returns a mesh with the same surface and each face twice, once for each side.
TriangleMesh twoSided(const TriangleMesh& mesh);
/// Returns a mesh with the same surface, as careless programs write it: some faces are turned around, some are given
/// twice or three times. How many is random, too.
TriangleMesh disordered(Random& random, const TriangleMesh& mesh);
/// Returns the triangles of both meshes.
TriangleMesh joined(TriangleMesh mesh, const TriangleMesh& other);
TriangleMesh moved(TriangleMesh mesh, const Eigen::Vector3d& by);
TriangleMesh without(TriangleMesh mesh, std::size_t triangle);
Shape meshOf(TriangleMesh mesh);

/// Returns a random closed solid of the given kind. A mesh has 12 .. 80 triangles. They may or may not share corners.
Shape randomSolid(Random& random, ShapeKind kind, const Proportions& proportions = {});

}  // namespace test
}  // namespace hgrid
