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

/// [m] How near to the border between hit and miss the rounding of peers in float may decide: some units in the last
/// place of the largest coordinate, 0.1 mm at least.
inline double doubtOf(const std::vector<Aabb>& boxes) {
  float largest = 0.f;
  for (const Aabb& box : boxes)
    largest = std::max({largest, box.min.cwiseAbs().maxCoeff(), box.max.cwiseAbs().maxCoeff()});
  return std::max(1e-4, 3.0 * double(std::nextafter(largest, std::numeric_limits<float>::infinity()) - largest));
}

/// Squared distance of a point from a box [m²], 0 inside.
inline double squaredGap(const Aabb& box, const Eigen::Vector3d& point) {
  double sum = 0.0;
  for (int axis = 0; axis < 3; ++axis) {
    const double off = std::max({0.0, double(box.min[axis]) - point[axis], point[axis] - double(box.max[axis])});
    sum += off * off;
  }
  return sum;
}

/// Which boxes a segment meets, by slabs: the last step of peers that find candidates only.
class SlabTest {
 public:
  explicit SlabTest(const Segment& segment)
      : from_(segment.from), inverse_((segment.to - segment.from).cwiseInverse()) {}

  /// @param by  [m] grows the box, or shrinks it
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

/// The box around a ball or a segment, rounded outwards: where peers look for candidates.
inline Aabb around(const Sphere& sphere) {
  Aabb box;
  for (int axis = 0; axis < 3; ++axis) {
    box.min[axis] = roundedDown(sphere.center[axis] - sphere.radius);
    box.max[axis] = roundedUp(sphere.center[axis] + sphere.radius);
  }
  return box;
}
inline Aabb around(const Segment& segment) {
  return {segment.from.cwiseMin(segment.to).cast<float>(), segment.from.cwiseMax(segment.to).cast<float>()};
}

}  // namespace bench
}  // namespace hgrid
