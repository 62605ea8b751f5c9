// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>

namespace hgrid {

/// An axis-aligned box [m]. Its faces belong to it: boxes that touch overlap. Coordinates are floats, which keeps the
/// box small. They are relative to the world's origin (a double), so that boxes far away keep their precision.
struct Aabb {
  Eigen::Vector3f min = Eigen::Vector3f::Zero();
  Eigen::Vector3f max = Eigen::Vector3f::Zero();

  bool operator==(const Aabb& other) const { return min == other.min && max == other.max; }
  bool operator!=(const Aabb& other) const { return !(*this == other); }
};

/// Finite, and min <= max on every axis.
bool isValid(const Aabb& box);

/// The largest float <= value, and the smallest float >= value; values beyond the floats become infinite.
float roundedDown(double value);
float roundedUp(double value);

/// Whether the two closed boxes have a point in common.
inline bool overlap(const Aabb& a, const Aabb& b) {
  return a.min.x() <= b.max.x() && b.min.x() <= a.max.x() && a.min.y() <= b.max.y() && b.min.y() <= a.max.y() &&
         a.min.z() <= b.max.z() && b.min.z() <= a.max.z();
}

/// Euclidean distance of the boxes [m], 0 if they overlap; exact to a few units in the last place.
double distance(const Aabb& a, const Aabb& b);

/// Whether the distance of the boxes is at most `margin` [m], margin >= 0. Decided exactly, as if computed with real
/// numbers: doubles suffice nearly always, and expansion arithmetic decides the rest (Shewchuk, Adaptive Precision
/// Floating-Point Arithmetic, 1997).
bool withinDistance(const Aabb& a, const Aabb& b, double margin);

/// A box that contains every point within `by` [m], by >= 0, of `box` along the axes. Two boxes within
/// m of each other overlap when grown by a and b with a + b >= m.
Aabb grown(const Aabb& box, double by);
inline Eigen::AlignedBox3d grown(const Eigen::AlignedBox3d& box, double by) {
  return {box.min().array() - by, box.max().array() + by};
}

/// The same box in double, without rounding.
inline Eigen::AlignedBox3d inDouble(const Aabb& box) { return {box.min.cast<double>(), box.max.cast<double>()}; }

/// The point of the box that is nearest to `point` [m]: `point` itself if it is inside.
inline Eigen::Vector3d nearestPoint(const Eigen::AlignedBox3d& box, const Eigen::Vector3d& point) {
  return point.cwiseMax(box.min()).cwiseMin(box.max());
}
inline Eigen::Vector3d nearestPoint(const Aabb& box, const Eigen::Vector3d& point) {
  return nearestPoint(inDouble(box), point);
}

/// [m] Length of the shortest move that separates two boxes that overlap; 0 if they do not.
double penetrationDepth(const Eigen::AlignedBox3d& first, const Eigen::AlignedBox3d& second);

/// A point of each of two boxes [m].
struct BoxPoints {
  Eigen::Vector3d on_first, on_second;
};

/// Points at which two boxes are nearest to each other. Where many are, these lie in the middle of them: on an axis on
/// which the boxes overlap, both points are in the middle of the overlap.
BoxPoints nearestPoints(const Eigen::AlignedBox3d& first, const Eigen::AlignedBox3d& second);

}  // namespace hgrid
