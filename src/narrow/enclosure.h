// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

#include <Eigen/Core>
#include <array>
#include <vector>

#include "hgrid_proximity/geometry/shape.h"

namespace hgrid {

/// The space that a mesh encloses, and some points of each connected part of the mesh.
class Enclosure {
 public:
  /// The extreme points of a connected part [m]: three minima, then three maxima, along x, y and z.
  using Part = std::array<Eigen::Vector3d, 6>;

  explicit Enclosure(const TriangleMesh& mesh);

  /// Whether each edge of a triangle has a matching edge of opposite direction in another triangle. Then the mesh is
  /// closed and has an inside.
  bool closed() const { return closed_; }
  /// Returns the extreme points of each connected part of the mesh.
  const std::vector<Part>& parts() const { return parts_; }
  /// Whether a point lies in the bounding box of the mesh. A point outside the box is not enclosed.
  /// @param point  [m, mesh frame]
  bool boxHolds(const Eigen::Vector3d& point) const {
    return (point.array() >= low_.array()).all() && (point.array() <= high_.array()).all();
  }
  /// Returns how often the mesh winds around a point: the sum of the signed solid angles of its triangles / (4 pi).
  ///
  /// For a closed mesh it is an integer, and 0 outside. For an open mesh it can be any number. The running time is
  /// linear in the number of triangles. See Jacobson, Kavan, Sorkine-Hornung 2013, "Robust Inside-Outside Segmentation
  /// using Generalized Winding Numbers"; the formula for the angle is by Van Oosterom and Strackee 1983.
  /// @param point  [m, mesh frame]
  double windingNumber(const Eigen::Vector3d& point) const;

 private:
  struct Corners {
    Eigen::Vector3d a, b, c;
  };
  bool closed_ = false;
  Eigen::Vector3d low_, high_;
  std::vector<Part> parts_;
  std::vector<Corners> triangles_;
};

}  // namespace hgrid
