// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

#include <algorithm>
#include <cmath>

#include "hgrid_proximity/geometry/aabb.h"

namespace hgrid {

/// A ball [m] in the coordinates of the boxes that it is asked about; radius 0 is a point.
struct Sphere {
  Eigen::Vector3d center = Eigen::Vector3d::Zero();
  double radius = 0.0;
};

/// The point of the box nearest to `point` [m]; the point itself inside.
Eigen::Vector3d nearestPoint(const Aabb& box, const Eigen::Vector3d& point);

/// Distance of the point from the box [m]; 0 inside.
inline double distance(const Aabb& box, const Eigen::Vector3d& point) {
  double sum = 0.0;  // axis by axis, without vectors: queries ask it of every candidate
  for (int axis = 0; axis < 3; ++axis) {
    const double gap = std::max(std::max(box.min[axis] - point[axis], point[axis] - box.max[axis]), 0.0);
    sum += gap * gap;
  }
  return std::sqrt(sum);
}

/// What a query adds to its size so that rounding can only add hits, never lose one: a bound of the
/// rounding errors for coordinates up to `reach` [m] and far below the promised 1e-9 * reach.
inline double roundingSlack(double reach) { return 1e-12 * reach; }

/// Boxes no farther than this [m] from the centre touch the ball.
inline double touchingDistance(const Sphere& sphere) {
  return sphere.radius + roundingSlack(sphere.center.cwiseAbs().maxCoeff() + sphere.radius);
}

/// Whether ball and box touch. Superset of the exact answer; an extra lies within 1e-9 * (|x| + r) of touching.
inline bool touches(const Sphere& sphere, const Aabb& box) {
  return distance(box, sphere.center) <= touchingDistance(sphere);
}

}  // namespace hgrid
