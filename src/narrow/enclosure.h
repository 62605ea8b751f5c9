// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

#include <Eigen/Core>
#include <array>
#include <vector>

#include "hgrid_proximity/geometry/shape.h"

namespace hgrid {

/// What a mesh encloses, and some points of each of its parts.
class Enclosure {
 public:
  /// Points of a connected part: its farthest along each axis, both ways.
  using Part = std::array<Eigen::Vector3d, 6>;

  explicit Enclosure(const TriangleMesh& mesh);

  /// Whether every edge of a triangle is met by that of another one the other way round: then the mesh has an inside.
  bool closed() const { return closed_; }
  const std::vector<Part>& parts() const { return parts_; }
  /// Whether a point lies in the mesh's box; what does not is not enclosed. @param point [m] in the mesh's frame
  bool boxHolds(const Eigen::Vector3d& point) const {
    return (point.array() >= low_.array()).all() && (point.array() <= high_.array()).all();
  }
  /// How often the mesh goes round a point: the sum of the signed solid angles of its triangles over 4 pi (Jacobson,
  /// Kavan, Sorkine-Hornung 2013, "Robust Inside-Outside Segmentation using Generalized Winding Numbers"; the angle
  /// after Van Oosterom and Strackee 1983). Of a closed mesh a whole number, 0 outside; of an open one something
  /// between. Looks at every triangle. @param point [m] in the mesh's frame
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
