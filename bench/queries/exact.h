// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "hgrid_proximity/geometry/aabb.h"
#include "hgrid_proximity/geometry/segment.h"
#include "hgrid_proximity/geometry/sphere.h"

namespace hgrid {
namespace bench {

/// Returns a tolerance [m]. If a box is nearer than this to the border between hit and miss, float rounding may decide
/// whether it is a hit. The tolerance is three units in the last place of the largest coordinate, at least 0.1 mm.
inline double doubtOf(const std::vector<Aabb>& boxes) {
  float largest = 0.f;
  for (const Aabb& box : boxes)
    largest = std::max({largest, box.min.cwiseAbs().maxCoeff(), box.max.cwiseAbs().maxCoeff()});
  return std::max(1e-4, 3.0 * double(std::nextafter(largest, std::numeric_limits<float>::infinity()) - largest));
}

/// Returns the squared distance of a point from a box [m²]; 0 inside the box.
inline double squaredGap(const Aabb& box, const Eigen::Vector3d& point) {
  double sum = 0.0;
  for (int axis = 0; axis < 3; ++axis) {
    const double off = std::max({0.0, double(box.min[axis]) - point[axis], point[axis] - double(box.max[axis])});
    sum += off * off;
  }
  return sum;
}

/// Tests whether a segment meets a box, with the slab method. Peers that find only candidates use it as the last step.
class SlabTest {
 public:
  explicit SlabTest(const Segment& segment)
      : from_(segment.from), inverse_((segment.to - segment.from).cwiseInverse()) {}

  /// Returns whether the segment meets the box. @param by  [m] first grows the box by this length; negative: shrinks it
  bool meets(const Aabb& box, double by = 0.0) const {
    double begin = 0.0, end = 1.0;
    for (int axis = 0; axis < 3; ++axis) {
      const double a = (double(box.min[axis]) - by - from_[axis]) * inverse_[axis];
      const double b = (double(box.max[axis]) + by - from_[axis]) * inverse_[axis];
      begin = std::max(begin, std::min(a, b));
      end = std::min(end, std::max(a, b));
    }
    return begin <= end;
  }

 private:
  Eigen::Vector3d from_, inverse_;
};

/// Returns the box around a sphere, rounded outward. Peers use it to find candidates.
inline Aabb around(const Sphere& sphere) {
  Aabb box;
  for (int axis = 0; axis < 3; ++axis) {
    box.min[axis] = roundedDown(sphere.center[axis] - sphere.radius);
    box.max[axis] = roundedUp(sphere.center[axis] + sphere.radius);
  }
  return box;
}
/// Returns the box around a segment. It is exact, because all coordinates of segments in the benchmark are floats.
inline Aabb around(const Segment& segment) {
  return {segment.from.cwiseMin(segment.to).cast<float>(), segment.from.cwiseMax(segment.to).cast<float>()};
}

}  // namespace bench
}  // namespace hgrid
