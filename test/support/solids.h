// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

#include <memory>

#include "hgrid_proximity/geometry/shape.h"
#include "test/support/random.h"

namespace hgrid {
namespace test {

/// How things are shaped: the longest measure and how many times longer than the shortest it may be.
struct Proportions {
  double smallest = 0.01;    ///< [m] of the longest measure
  double largest = 2.0;      ///< [m] of the longest measure
  double max_aspect = 50.0;  ///< longest to shortest measure
};

/// Closed meshes around the origin, all triangles counter-clockwise seen from outside.
TriangleMesh boxMesh(const Eigen::Vector3d& size);
/// Of radius 1; 20 triangles, four times as many with each division.
TriangleMesh ballMesh(int divisions);
/// A ball mesh of 20 or 80 triangles whose corners lie at 0.5 .. 1 of its radius: closed, seldom convex, never cut by
/// itself; stretched to `size`.
TriangleMesh lumpMesh(Random& random, const Eigen::Vector3d& size);

/// The same surface as an STL file holds it: each triangle with three corners of its own.
TriangleMesh unwelded(const TriangleMesh& mesh);
TriangleMesh moved(TriangleMesh mesh, const Eigen::Vector3d& by);
TriangleMesh without(TriangleMesh mesh, std::size_t triangle);
Shape meshOf(TriangleMesh mesh);

/// A closed solid of any kind; meshes have 12 .. 80 triangles, with or without corners in common.
Shape randomSolid(Random& random, ShapeKind kind, const Proportions& proportions = {});

}  // namespace test
}  // namespace hgrid
