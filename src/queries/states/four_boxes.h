// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

#include "hgrid_proximity/geometry/aabb.h"
#include "queries/states/tilted_box.h"

namespace hgrid {

/// Four axis-aligned boxes, relative to the origin of the snapshot.
struct FourBounds {
  Four min[3], max[3];  ///< [m] corners
};

/// A shape in four states of the robot. The boxes are relative to the origin of the snapshot.
struct FourShapes {
  TiltedBox<Four> box;
  FourBounds bounds;  ///< axis-aligned box around `box`
  Four rounding;      ///< [m] bound of the rounding errors of the center of `box`; its half lengths contain it
};

/// Returns for each lane the box around two boxes.
inline FourBounds around(const FourBounds& a, const FourBounds& b) {
  FourBounds all;
  for (std::size_t k = 0; k < 3; ++k) {
    all.min[k] = least(a.min[k], b.min[k]);
    all.max[k] = greatest(a.max[k], b.max[k]);
  }
  return all;
}

/// Returns for each lane whether two boxes are at most `by` [m] apart along each axis.
inline unsigned overlapping(const FourBounds& a, const FourBounds& b, const Four& by) {
  Four gap = greatest(a.min[0] - b.max[0], b.min[0] - a.max[0]);
  for (std::size_t k = 1; k < 3; ++k) gap = greatest(gap, greatest(a.min[k] - b.max[k], b.min[k] - a.max[k]));
  return bitsOf(reinterpret_cast<FourCounts>(gap <= by));
}

/// Returns for each lane whether two boxes are at most `by` [m] apart along each axis.
inline unsigned overlapping(const FourBounds& a, const Aabb& b, const Four& by) {
  auto lanes = (a.min[0] <= allFour(b.max[0]) + by) & (allFour(b.min[0]) - by <= a.max[0]);
  for (Eigen::Index k = 1; k < 3; ++k) {
    lanes &= (a.min[k] <= allFour(b.max[k]) + by) & (allFour(b.min[k]) - by <= a.max[k]);
  }
  return bitsOf(reinterpret_cast<FourCounts>(lanes));
}

}  // namespace hgrid
