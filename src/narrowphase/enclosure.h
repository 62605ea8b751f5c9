// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

#include <Eigen/Core>
#include <vector>

#include "hgrid_proximity/geometry/shape.h"

namespace hgrid {

/// What a mesh encloses, and one point of each of its parts.
class Enclosure {
 public:
  explicit Enclosure(const TriangleMesh& mesh);

  /// Whether every edge of a triangle is met by that of another one the other way round: then the mesh has an inside.
  bool closed() const { return closed_; }
  /// A vertex of every connected part of the mesh.
  const std::vector<Eigen::Vector3d>& parts() const { return parts_; }
  /// How often the mesh goes round a point: the sum of the signed solid angles of its triangles over 4 pi (Jacobson,
  /// Kavan, Sorkine-Hornung 2013, "Robust Inside-Outside Segmentation using Generalized Winding Numbers"; the angle after
  /// Van Oosterom and Strackee 1983). Of a closed mesh a whole number, 0 outside; of an open one something between. 0
  /// without counting where the point lies outside the mesh's box. @param point [m] in the mesh's frame
  double windingNumber(const Eigen::Vector3d& point) const;

 private:
  struct Corners {
    Eigen::Vector3d a, b, c;
  };
  bool closed_ = false;
  Eigen::Vector3d low_, high_;
  std::vector<Eigen::Vector3d> parts_;
  std::vector<Corners> triangles_;
};

}  // namespace hgrid
