// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

#include <algorithm>
#include <cmath>
#include <vector>

#include "hgrid_proximity/geometry/aabb.h"
#include "test/support/exact.h"

namespace hgrid {
namespace test {

/// The oracle for boxes computes reference answers by brute force. It uses exact arithmetic (Exact) or extended
/// precision (long double). Of the product it uses only the struct Aabb.

inline bool oracleOverlap(const Aabb& a, const Aabb& b) {
  for (int k = 0; k < 3; ++k) {
    if (a.max[k] < b.min[k] || b.max[k] < a.min[k]) return false;
  }
  return true;
}

/// Returns how far x lies outside of [low, high]; 0 if it lies inside.
inline Exact outside(const Exact& x, double low, double high) {
  if (x < Exact(low)) return Exact(low) - x;
  if (Exact(high) < x) return x - Exact(high);
  return Exact(0.0);
}

inline Exact exactSquaredDistance(const Aabb& a, const Aabb& b) {
  Exact sum;
  for (int k = 0; k < 3; ++k) {
    Exact gap;
    if (a.max[k] < b.min[k]) gap = Exact(b.min[k]) - Exact(a.max[k]);
    if (b.max[k] < a.min[k]) gap = Exact(a.min[k]) - Exact(b.max[k]);
    sum = sum + gap * gap;
  }
  return sum;
}

inline Exact exactSquaredDistance(const Aabb& box, const Eigen::Vector3d& point) {
  Exact sum;
  for (int k = 0; k < 3; ++k) {
    const Exact gap = outside(Exact(point[k]), box.min[k], box.max[k]);
    sum = sum + gap * gap;
  }
  return sum;
}

/// Returns whether the distance of the boxes is at most `margin` [m], computed without rounding.
inline bool exactlyWithin(const Aabb& a, const Aabb& b, double margin) {
  return exactSquaredDistance(a, b) <= Exact(margin) * Exact(margin);
}

/// Returns the same as exactlyWithin(), but is usually much faster. It first computes with extended precision. Only if
/// the distance is too close to `margin` for that, it computes exactly.
inline bool oracleWithin(const Aabb& a, const Aabb& b, double margin) {
  long double sum = 0;
  for (int k = 0; k < 3; ++k) {
    const long double gap = std::max({0.0L, (long double)b.min[k] - a.max[k], (long double)a.min[k] - b.max[k]});
    sum += gap * gap;
  }
  const long double distance = std::sqrt(sum);
  if (distance < margin * (1 - 1e-12L)) return true;
  if (distance > margin * (1 + 1e-12L) + 1e-2000L) return false;
  return exactlyWithin(a, b, margin);
}

inline bool exactlyTouches(const Aabb& box, const Eigen::Vector3d& center, double radius) {
  return exactSquaredDistance(box, center) <= Exact(radius) * Exact(radius);
}

/// Returns whether the segment from a to b, end points included, touches the box.
///
/// A slab is the space between two opposite faces of the box. The segment enters and leaves each slab at a fraction of
/// its length. The function compares these fractions by cross-multiplication, without rounding.
inline bool exactlyMeets(const Aabb& box, const Eigen::Vector3d& a, const Eigen::Vector3d& b) {
  // Fractions (numerator, denominator > 0) of the length, from 0 to 1, at which the segment enters and leaves the
  // slabs.
  std::vector<std::pair<Exact, Exact>> enter{{Exact(0.0), Exact(1.0)}}, leave{{Exact(1.0), Exact(1.0)}};
  for (int k = 0; k < 3; ++k) {
    const Exact way = Exact(b[k]) - Exact(a[k]);
    Exact low = Exact(box.min[k]) - Exact(a[k]), high = Exact(box.max[k]) - Exact(a[k]);
    if (way.sign() == 0) {
      if (low.sign() > 0 || high.sign() < 0) return false;
      continue;
    }
    if (way.sign() < 0) {
      enter.emplace_back(-high, -way);
      leave.emplace_back(-low, -way);
    } else {
      enter.emplace_back(low, way);
      leave.emplace_back(high, way);
    }
  }
  for (const auto& in : enter) {
    for (const auto& out : leave) {
      if (out.first * in.second < in.first * out.second) return false;
    }
  }
  return true;
}

/// How near the axis of a segment comes to a box. approachOf() computes it with extended precision by bisection.
struct Approach {
  long double least = 0;  ///< [m] least distance between the axis and the box
  long double first = 0;  ///< [m] length of the axis up to its first point within `radius` of the box; infinite if none
};

inline long double distanceAt(const Aabb& box, const Eigen::Vector3d& a, const Eigen::Vector3d& b, long double t,
                              long double* slope = nullptr) {
  long double sum = 0;
  if (slope) *slope = 0;
  for (int k = 0; k < 3; ++k) {
    const long double way = (long double)b[k] - a[k];
    const long double x = a[k] + t * way;
    const long double gap = x < box.min[k] ? x - box.min[k] : x > box.max[k] ? x - box.max[k] : 0;
    sum += gap * gap;
    if (slope) *slope += gap * way;
  }
  return std::sqrt(sum);
}

inline Approach approachOf(const Aabb& box, const Eigen::Vector3d& a, const Eigen::Vector3d& b, double radius) {
  // The distance is a convex function of the fraction t of the axis, so its slope changes sign only once.
  long double low = 0, high = 1, slope = 0;
  for (int i = 0; i < 70; ++i) {
    const long double middle = (low + high) / 2;
    distanceAt(box, a, b, middle, &slope);
    (slope < 0 ? low : high) = middle;
  }
  // `low` and `high` now enclose the first of the nearest points, even if the axis is parallel to a side of the box.
  Approach found;
  const long double ends[] = {distanceAt(box, a, b, 0), distanceAt(box, a, b, 1), distanceAt(box, a, b, low),
                              distanceAt(box, a, b, high)};
  found.least = *std::min_element(std::begin(ends), std::end(ends));
  if (found.least > radius) {
    found.first = std::numeric_limits<long double>::infinity();
    return found;
  }
  long double before = 0, there = ends[1] <= radius && ends[2] > radius ? 1 : low;
  if (distanceAt(box, a, b, there) > radius) there = high;
  if (ends[0] <= radius) there = 0;
  for (int i = 0; i < 70 && there > 0; ++i) {
    const long double middle = (before + there) / 2;
    (distanceAt(box, a, b, middle) <= radius ? there : before) = middle;
  }
  long double length = 0;
  for (int k = 0; k < 3; ++k) length += ((long double)b[k] - a[k]) * ((long double)b[k] - a[k]);
  found.first = there * std::sqrt(length);
  return found;
}

/// Returns the rounding error [m] that the documentation allows for a query: 1e-9 * (|x| + r).
inline double promisedSlack(const Eigen::Vector3d& a, const Eigen::Vector3d& b, double radius) {
  return 1e-9 * (std::max(a.norm(), b.norm()) + radius);
}

}  // namespace test
}  // namespace hgrid
