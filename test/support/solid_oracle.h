// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

#include "test/support/depth_oracle.h"

namespace hgrid {
namespace test {

/// A shape in the world as the witness sees it: convex pieces, the triangles of a mesh or the shape itself. Of the
/// product it uses the measures of the shape and nothing else.
class SolidOracle {
 public:
  SolidOracle(const Shape& shape, const Pose& world_from_shape, double padding);

  const std::vector<Convex>& pieces() const { return pieces_; }
  Real radius() const { return pieces_.front().radius(); }

  /// A mesh each side of which meets its opposite, corners being the same if their coordinates are.
  bool isClosed() const { return closed_; }

  /// Whether a point lies within the surface of a closed mesh: the greater part of a few rays leaves it once more
  /// often than it enters. Points on the surface may be either.
  bool encloses(const Vector3r& point) const;

 private:
  std::vector<Convex> pieces_;
  std::vector<std::array<Vector3r, 3>> triangles_;
  bool closed_ = false;
};

/// Two solids: how far apart, and nearest points of their cores (the shapes without their radii).
struct SolidDistance {
  Interval interval;      ///< [m] with the radii; 0 in contact, and if one lies within the other
  bool enclosed = false;  ///< their surfaces are apart, and one lies within the other, a closed mesh
  Vector3r on_first = Vector3r::Zero(), on_second = Vector3r::Zero();
};
SolidDistance distanceOf(const SolidOracle& first, const SolidOracle& second);

/// The distance of a point from a solid; 0 inside.
Interval distanceOf(const SolidOracle& solid, const Eigen::Vector3d& point);

/// Whether two solids certainly overlap by more than `depth` [m].
bool overlapByMore(const SolidOracle& first, const SolidOracle& second, double depth);

}  // namespace test
}  // namespace hgrid
