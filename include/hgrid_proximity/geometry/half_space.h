// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

#include "hgrid_proximity/geometry/aabb.h"
#include "hgrid_proximity/geometry/pose.h"

namespace hgrid {

/// A half-space [m]: the points x with normal · x <= offset. It is closed, so its surface belongs to it.
struct HalfSpace {
  Eigen::Vector3d normal = Eigen::Vector3d::UnitZ();  ///< unit vector that points out of the half-space
  double offset = 0.0;                                ///< [m] signed distance of the surface from the origin
  double rounding = 0.0;                              ///< [m] bound of the rounding error of `offset`

  /// Returns whether all values are equal. Then distance() gives equal results for both half-spaces.
  bool operator==(const HalfSpace& other) const {
    return normal == other.normal && offset == other.offset && rounding == other.rounding;
  }
};

/// Returns the half-space of a plane: the points that are not above the plane z = 0 of its frame, grown by `padding`.
/// @param world_from_plane  pose of the plane
/// @param padding           [m] how far the surface is moved outward
/// @param origin            [m, world] the result is relative to this point
HalfSpace halfSpaceOf(const Pose& world_from_plane, double padding, const Eigen::Vector3d& origin);

/// Returns the signed distance [m] of a point from the surface. It is negative inside.
double signedDistance(const HalfSpace& half_space, const Eigen::Vector3d& point);

/// Returns the corner of the box [m] that is deepest in the half-space, or nearest to it. If several are, returns the
/// one with the smallest coordinates.
Eigen::Vector3d deepestCorner(const HalfSpace& half_space, const Eigen::AlignedBox3d& box);

/// Returns the distance [m] of a box from the half-space, or 0 if they touch. Rounding makes it smaller, never larger:
/// by at most 1e-13 of the coordinates of the box, the plane and the origin of halfSpaceOf().
double distance(const HalfSpace& half_space, const Aabb& box);

}  // namespace hgrid
