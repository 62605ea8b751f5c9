// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

#include <cmath>

#include "hgrid_proximity/geometry/aabb.h"

namespace hgrid {

/// A sphere [m], relative to the same frame as the boxes that it is compared with. With radius 0 it is a point.
struct Sphere {
  Eigen::Vector3d center = Eigen::Vector3d::Zero();  ///< [m] center of the sphere
  double radius = 0.0;                               ///< [m] radius of the sphere, >= 0
};

/// Returns the squared distance of the point from the box [m²], or 0 if the point is inside.
inline double squaredDistance(const Aabb& box, const Eigen::Vector3d& point) {
  // Computes axis by axis, without vectors and branches, because queries call this for every candidate.
  double sum = 0.0;
  for (int axis = 0; axis < 3; ++axis) {
    const double under = box.min[axis] - point[axis], over = point[axis] - box.max[axis];
    const double off = under > over ? under : over;
    const double gap = 0.5 * (off + std::abs(off));  // not std::max(off, 0.0): compilers turn it into a branch
    sum += gap * gap;
  }
  return sum;
}

/// Returns the distance of the point from the box [m], or 0 if the point is inside.
inline double distance(const Aabb& box, const Eigen::Vector3d& point) { return std::sqrt(squaredDistance(box, point)); }

/// Returns the length [m] by which a query grows itself, so that rounding can add a hit but never lose one. It is a
/// bound of the rounding errors for coordinates up to `largest` [m] and is far below the promised 1e-9 * largest.
constexpr double roundingSlack(double largest) { return 1e-12 * largest; }

/// Returns the largest distance [m] from the center of the sphere at which a box still counts as touching it.
inline double touchingDistance(const Sphere& sphere) {
  return sphere.radius + roundingSlack(sphere.center.cwiseAbs().maxCoeff() + sphere.radius);
}

/// Whether sphere and box touch. A box that touches is never missed. A box that misses the sphere by less than 1e-9 *
/// (|x| + r) may count as touching, where |x| is the largest coordinate and r the radius.
inline bool touches(const Sphere& sphere, const Aabb& box) {
  const double near = touchingDistance(sphere);
  return squaredDistance(box, sphere.center) <= near * near;
}

}  // namespace hgrid
