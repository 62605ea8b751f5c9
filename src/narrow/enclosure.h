// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

#include <Eigen/Core>
#include <array>
#include <vector>

#include "hgrid_proximity/geometry/shape.h"
#include "narrow/winding_tree.h"

namespace hgrid {

/// The space that a mesh encloses, and some points of each connected part of the mesh.
class Enclosure {
 public:
  /// The extreme points of a connected part [m]: three minima, then three maxima, along x, y and z.
  using Part = std::array<Eigen::Vector3d, 6>;

  explicit Enclosure(const TriangleMesh& mesh);

  /// Whether the mesh is closed, so that it has an inside. See WindingTree::closed().
  bool closed() const { return winding_.closed(); }
  /// Returns the extreme points of each connected part of the mesh.
  const std::vector<Part>& parts() const { return parts_; }
  /// Whether a point lies in the bounding box of the mesh. A point outside the box is not enclosed.
  /// @param point  [m, mesh frame]
  bool boxHolds(const Eigen::Vector3d& point) const { return winding_.boxHolds(point); }
  /// Returns how often the mesh winds around a point. See WindingTree.
  /// @param point  [m, mesh frame]
  double windingNumber(const Eigen::Vector3d& point) const { return winding_.windingNumber(point); }

 private:
  Enclosure(const TriangleMesh& mesh, const std::vector<WindingTree::Corners>& triangles);

  WindingTree winding_;
  std::vector<Part> parts_;
};

}  // namespace hgrid
