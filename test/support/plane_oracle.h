// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

#include "hgrid_proximity/geometry/aabb.h"
#include "hgrid_proximity/geometry/pose.h"
#include "test/support/exact.h"

namespace hgrid {
namespace test {

/// The references for planes compute without rounding. Of the product they use only the structs Aabb and Pose.

/// Returns the signed distance [m] of a point from the surface of a padded plane. It is exact if the last column of the
/// rotation is a unit vector.
/// @param point   [m] relative to `origin`
/// @param origin  [m, world]
inline Exact exactHeight(const Eigen::Vector3d& point, const Pose& world_from_plane, double padding,
                         const Eigen::Vector3d& origin) {
  Exact height = -Exact(padding);
  for (int k = 0; k < 3; ++k) {
    height = height + Exact(world_from_plane.linear()(k, 2)) *
                          (Exact(point[k]) + Exact(origin[k]) - Exact(world_from_plane.translation()[k]));
  }
  return height;
}

/// Returns the signed distance [m] of a box from the surface of a padded plane: that of its lowest corner.
inline Exact exactHeight(const Aabb& box, const Pose& world_from_plane, double padding, const Eigen::Vector3d& origin) {
  Exact least;
  for (int corner = 0; corner < 8; ++corner) {
    Eigen::Vector3d point;
    for (int k = 0; k < 3; ++k) point[k] = double((corner >> k & 1) != 0 ? box.max[k] : box.min[k]);
    const Exact height = exactHeight(point, world_from_plane, padding, origin);
    if (corner == 0 || height < least) least = height;
  }
  return least;
}

/// Returns the largest accepted error [m] of the distance of a box from a plane: a little fraction of the coordinates.
inline double planeRounding(const Aabb& box, const Pose& world_from_plane, double padding,
                            const Eigen::Vector3d& origin) {
  const double box_size = double(std::max(box.min.cwiseAbs().maxCoeff(), box.max.cwiseAbs().maxCoeff()));
  return 1e-13 *
         (box_size + world_from_plane.translation().cwiseAbs().maxCoeff() + origin.cwiseAbs().maxCoeff() + padding);
}

}  // namespace test
}  // namespace hgrid
