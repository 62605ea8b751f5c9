// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

#include <cmath>

#include "hgrid_proximity/geometry/aabb.h"

namespace hgrid {

/// A sphere, filled [m], in the coordinates of the boxes that it is asked about; radius 0 is a point.
struct Sphere {
  Eigen::Vector3d center = Eigen::Vector3d::Zero();
  double radius = 0.0;
};

/// The point of the box nearest to `point` [m]; the point itself inside.
Eigen::Vector3d nearestPoint(const Aabb& box, const Eigen::Vector3d& point);

/// Squared distance of the point from the box [m²]; 0 inside.
inline double squaredDistance(const Aabb& box, const Eigen::Vector3d& point) {
  double sum = 0.0;  // axis by axis, without vectors and without branches: queries ask it of every candidate
  for (int axis = 0; axis < 3; ++axis) {
    const double under = box.min[axis] - point[axis], over = point[axis] - box.max[axis];
    const double off = under > over ? under : over;
    const double gap =
        0.5 * (off + std::abs(off));  // the greater of off and 0; written with std::max, compilers branch
    sum += gap * gap;
  }
  return sum;
}

/// Distance of the point from the box [m]; 0 inside.
inline double distance(const Aabb& box, const Eigen::Vector3d& point) { return std::sqrt(squaredDistance(box, point)); }

/// What a query adds to its size so that rounding can only add hits, never lose one: a bound of the
/// rounding errors for coordinates up to `reach` [m] and far below the promised 1e-9 * reach.
inline double roundingSlack(double reach) { return 1e-12 * reach; }

/// Boxes no farther than this [m] from the center touch the sphere; squares of both are compared.
inline double touchingDistance(const Sphere& sphere) {
  return sphere.radius + roundingSlack(sphere.center.cwiseAbs().maxCoeff() + sphere.radius);
}

/// Whether sphere and box touch. Superset of the exact answer; an extra lies within 1e-9 * (|x| + r) of touching.
inline bool touches(const Sphere& sphere, const Aabb& box) {
  const double near = touchingDistance(sphere);
  return squaredDistance(box, sphere.center) <= near * near;
}

}  // namespace hgrid
