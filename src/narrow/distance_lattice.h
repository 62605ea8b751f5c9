// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <vector>

#include "geometry/four_lanes.h"
#include "narrow/triangle_gap.h"

namespace hgrid {

/// Tells quickly that points are far from a closed mesh and from the space that it encloses. Immutable.
///
/// A box around the mesh is divided into cells, which are cubes. A cell is free if no triangle touches it and a path
/// of such cells, face to face, leads out of the box. For each cell, there is a lower bound of the distance from its
/// center to the nearest cell that is not free. It is computed along x, then y, then z (Felzenszwalb and Huttenlocher
/// 2012, "Distance transforms of sampled functions"). There are at most 64^3 cells, which take one byte each.
class DistanceLattice {
 public:
  /// Takes some milliseconds, and longer for more than thousands of triangles. @param triangles  of a closed mesh, at
  /// least one
  explicit DistanceLattice(const std::vector<Triangle>& triangles);

  /// Returns the lowest corner of the first cell [m, mesh frame].
  const Eigen::Vector3d& corner() const { return corner_; }
  /// Returns the unit of lengths [m], the edge of a cell.
  double edge() const { return edge_; }
  /// Returns for four points a lower bound of the distance from the mesh and from the space that it encloses, in edges.
  /// @param points  for each axis: coordinates relative to corner(), in edges
  Four lowerBounds(const Four (&points)[3]) const;
  /// Returns whether a point is in a free cell or outside all cells. It is then surely not inside the mesh.
  /// @param point  [m, mesh frame]
  bool isOutside(const Eigen::Vector3d& point) const;

 private:
  class Cells;

  Eigen::Vector3d corner_;
  double edge_;
  std::array<float, 3> counts_;       // number of cells along each axis
  std::vector<std::uint8_t> bounds_;  // for each cell: the lower bound, in steps
};

}  // namespace hgrid
