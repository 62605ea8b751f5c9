// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>

namespace hgrid {

/// An axis-aligned box [m]. The box is closed: boxes that only touch do overlap.
///
/// The coordinates are floats to save memory. In a snapshot they are relative to Snapshot::origin(), a point in double
/// precision. So boxes keep their precision far away from the origin of the world frame.
struct Aabb {
  Eigen::Vector3f min = Eigen::Vector3f::Zero();  ///< [m] smallest coordinate on each axis
  Eigen::Vector3f max = Eigen::Vector3f::Zero();  ///< [m] largest coordinate on each axis

  /// Whether both boxes have the same corners.
  bool operator==(const Aabb& other) const { return min == other.min && max == other.max; }
  /// Whether the boxes have different corners.
  bool operator!=(const Aabb& other) const { return !(*this == other); }
};

/// Whether all coordinates are finite and min <= max holds on every axis.
bool isValid(const Aabb& box);

/// Returns the float that is nearest to `value`, as a double. Use this where a number must have the digits of a float.
/// In an expression, g++ 12.2 leaves out both conversions of 2, 3, 6, 7, 10 and more numbers in a row, from -O2 on.
inline double throughFloat(double value) {
  volatile float rounded = static_cast<float>(value);
  return static_cast<double>(rounded);
}

/// Returns the largest float that is not larger than `value`; -infinity if `value` is below the range of float.
float roundedDown(double value);
/// Returns the smallest float that is not smaller than `value`; infinity if `value` is above the range of float.
float roundedUp(double value);

/// Whether the two boxes have at least one point in common.
inline bool overlap(const Aabb& a, const Aabb& b) {
  return a.min.x() <= b.max.x() && b.min.x() <= a.max.x() && a.min.y() <= b.max.y() && b.min.y() <= a.max.y() &&
         a.min.z() <= b.max.z() && b.min.z() <= a.max.z();
}

/// Returns the Euclidean distance of the boxes [m], or 0 if they overlap. It is exact to a few units in the last place.
double distance(const Aabb& a, const Aabb& b);

/// Whether the distance of the boxes is at most `margin` [m], with margin >= 0.
///
/// The decision is exact, as if computed with real numbers. Doubles are nearly always sufficient. Expansion arithmetic
/// decides the remaining cases (Shewchuk, Adaptive Precision Floating-Point Arithmetic, 1997).
bool withinDistance(const Aabb& a, const Aabb& b, double margin);

///@{
/// Returns `box` with every face moved outward by at least `by` [m]; `by` must not be negative. Two boxes that are at
/// most a + b apart overlap after one of them is grown by a and the other by b.
Aabb grown(const Aabb& box, double by);
inline Eigen::AlignedBox3d grown(const Eigen::AlignedBox3d& box, double by) {
  return {box.min().array() - by, box.max().array() + by};
}
///@}

/// Returns the same box in double, without rounding.
inline Eigen::AlignedBox3d inDouble(const Aabb& box) { return {box.min.cast<double>(), box.max.cast<double>()}; }

///@{
/// Returns the point of the box that is nearest to `point` [m], or `point` itself if it is inside.
inline Eigen::Vector3d nearestPoint(const Eigen::AlignedBox3d& box, const Eigen::Vector3d& point) {
  return point.cwiseMax(box.min()).cwiseMin(box.max());
}
inline Eigen::Vector3d nearestPoint(const Aabb& box, const Eigen::Vector3d& point) {
  return nearestPoint(inDouble(box), point);
}
///@}

/// Returns the length [m] of the shortest translation that separates two overlapping boxes, or 0 if they do not
/// overlap.
double penetrationDepth(const Eigen::AlignedBox3d& first, const Eigen::AlignedBox3d& second);

/// One point of each of two boxes [m].
struct BoxPoints {
  Eigen::Vector3d on_first;   ///< [m] point of the first box
  Eigen::Vector3d on_second;  ///< [m] point of the second box
};

/// Returns a nearest point on each of two boxes. If there are many such pairs of points, it returns the middle ones: on
/// an axis on which the boxes overlap, both points are in the middle of the overlap.
BoxPoints nearestPoints(const Eigen::AlignedBox3d& first, const Eigen::AlignedBox3d& second);

}  // namespace hgrid
