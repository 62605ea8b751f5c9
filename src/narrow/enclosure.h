// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

#include <Eigen/Geometry>
#include <array>
#include <vector>

#include "hgrid_proximity/geometry/shape.h"
#include "narrow/face_directions.h"
#include "narrow/winding_tree.h"

namespace hgrid {

/// Whether a point is inside a mesh.
enum class Inside { no, yes, unknown };

/// The space that a mesh encloses, and some points of each connected part of the mesh.
///
/// A mesh winds around a point inside it. The directions of its triangles do not matter as far as they can be corrected
/// (see FaceDirections). Where they cannot, a point is outside only if straight lines lead out, or if the sides of the
/// triangles that lines from it meet fit together.
class Enclosure {
 public:
  /// The extreme points of a connected part [m]: three minima, then three maxima, along x, y and z.
  using Part = std::array<Eigen::Vector3d, 6>;

  explicit Enclosure(const TriangleMesh& mesh);

  /// Whether the mesh is closed and a path leads to each point that is not inside from far away. If not, holds() may
  /// give different answers for points between which there is no triangle.
  bool simple() const { return simple_; }
  /// Returns the extreme points of each connected part of the mesh.
  const std::vector<Part>& parts() const { return parts_; }
  /// Whether a point lies in the bounding box of the mesh. A point outside the box is not enclosed.
  /// @param point  [m, mesh frame]
  bool boxHolds(const Eigen::Vector3d& point) const { return box_.contains(point); }
  /// @param point  [m, mesh frame] not on a triangle
  Inside holds(const Eigen::Vector3d& point) const;

 private:
  Enclosure(const TriangleMesh& mesh, const std::vector<WindingTree::Corners>& triangles);

  void findParts(const std::vector<Eigen::Vector3d>& vertices, const std::vector<WindingTree::Corners>& triangles);
  /// Whether hardly any line leads out from a point, and the sides that lines from it meet contradict each other.
  bool isWalledIn(const Eigen::Vector3d& point) const;

  std::vector<WindingTree> surfaces_;  // that of the given directions, and that of the corrected ones
  std::vector<Part> parts_;
  Eigen::AlignedBox3d box_;  // [m]
  bool closed_ = false;      // whether each edge of a triangle has a matching edge of opposite direction
  bool simple_ = false;      // see simple()
  bool corrected_ = false;   // whether some directions are not the given ones
};

/// Returns the triangles of a mesh. Vertices at the same position get the same number, since many files repeat a vertex
/// for every triangle that uses it. Leaves out triangles with two equal corners, since they are lines, which enclose
/// nothing.
std::vector<WindingTree::Corners> weldedTriangles(const TriangleMesh& mesh);

}  // namespace hgrid
