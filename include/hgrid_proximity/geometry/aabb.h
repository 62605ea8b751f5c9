// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

#include <Eigen/Core>

namespace hgrid {

/// An axis-aligned box [m], both faces included: boxes that touch overlap. In float, to be small;
/// coordinates are relative to the world's origin (a double), so that far worlds keep precision.
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

/// Whether the distance of the boxes is at most `margin` [m], margin >= 0: decided exactly, as if
/// computed with real numbers. A filter in double answers nearly always; the rest is settled by
/// expansion arithmetic (Shewchuk, Adaptive Precision Floating-Point Arithmetic, 1997).
bool withinDistance(const Aabb& a, const Aabb& b, double margin);

/// A box that contains every point within `by` [m], by >= 0, of `box` along the axes. Two boxes within
/// m of each other overlap when grown by a and b with a + b >= m.
Aabb grown(const Aabb& box, double by);

}  // namespace hgrid
