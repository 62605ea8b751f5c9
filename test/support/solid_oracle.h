// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

#include "test/support/depth_oracle.h"

namespace hgrid {
namespace test {

/// A shape in the world frame, represented by one or more convex pieces. The pieces of a mesh are its triangles. Any
/// other shape is one piece. Of the product, this class uses only the data of the shape.
class SolidOracle {
 public:
  SolidOracle(const Shape& shape, const Pose& world_from_shape, double padding);

  const std::vector<Convex>& pieces() const { return pieces_; }
  Real radius() const { return pieces_.front().radius(); }

  /// Returns whether the shape is a closed mesh: each side of a triangle has an opposite side of another triangle.
  /// Corners with equal coordinates are one corner.
  bool isClosed() const { return closed_; }

  /// Returns whether a point is inside a closed mesh: most of five rays from the point cross the surface an odd number
  /// of times. If the point is on the surface, the result may be either.
  bool encloses(const Vector3r& point) const;

 private:
  std::vector<Convex> pieces_;
  std::vector<std::array<Vector3r, 3>> triangles_;
  bool closed_ = false;
};

/// The distance of two solids, and the nearest points of their cores (see Convex).
struct SolidDistance {
  Interval interval;      ///< [m] distance including radii; 0 if they touch, or if one is inside the other
  bool enclosed = false;  ///< whether the surfaces are apart and one solid is inside the other, a closed mesh
  Vector3r on_first = Vector3r::Zero(), on_second = Vector3r::Zero();
};
SolidDistance distanceOf(const SolidOracle& first, const SolidOracle& second);

/// Returns bounds of the distance [m] of a point from a solid; 0 if the point is inside.
Interval distanceOf(const SolidOracle& solid, const Eigen::Vector3d& point);

/// Returns whether two solids certainly overlap by more than `depth` [m].
bool overlapByMore(const SolidOracle& first, const SolidOracle& second, double depth);

}  // namespace test
}  // namespace hgrid
