// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

#include <cmath>

#include "hgrid_proximity/geometry/aabb.h"

namespace hgrid {

/// A sphere [m], in the same coordinates as the boxes that it is compared with. With radius 0 it is a point.
struct Sphere {
  Eigen::Vector3d center = Eigen::Vector3d::Zero();
  double radius = 0.0;
};

/// Squared distance of the point from the box [m²]; 0 inside.
inline double squaredDistance(const Aabb& box, const Eigen::Vector3d& point) {
  double sum = 0.0;  // axis by axis, without vectors and without branches: queries call this for every candidate
  for (int axis = 0; axis < 3; ++axis) {
    const double under = box.min[axis] - point[axis], over = point[axis] - box.max[axis];
    const double off = under > over ? under : over;
    const double gap = 0.5 * (off + std::abs(off));  // not std::max(off, 0.0): compilers make a branch of that
    sum += gap * gap;
  }
  return sum;
}

/// Distance of the point from the box [m]; 0 inside.
inline double distance(const Aabb& box, const Eigen::Vector3d& point) { return std::sqrt(squaredDistance(box, point)); }

/// [m] What a query adds to its size, so that rounding can add hits but never lose one. It bounds the rounding errors
/// for coordinates up to `reach` [m] and is far below the promised 1e-9 * reach.
inline double roundingSlack(double reach) { return 1e-12 * reach; }

/// [m] A box touches the sphere if it is at most this far from the sphere's center.
inline double touchingDistance(const Sphere& sphere) {
  return sphere.radius + roundingSlack(sphere.center.cwiseAbs().maxCoeff() + sphere.radius);
}

/// Whether sphere and box touch. True for every box that touches, and perhaps for one that misses by less than
/// 1e-9 * (|x| + r).
inline bool touches(const Sphere& sphere, const Aabb& box) {
  const double near = touchingDistance(sphere);
  return squaredDistance(box, sphere.center) <= near * near;
}

}  // namespace hgrid
