// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

#include "queries/states/four_boxes.h"
#include "queries/states/sphere_cover.h"

namespace hgrid {

/// Bound of the rounding errors of a point of a shape in another frame, as a part of the sum of all lengths from which
/// the point is computed.
inline constexpr float kPointRounding = 4e-6f;

/// Returns one bit for each of four states: whether all spheres of a cover are surely farther than `reach` from
/// something, in a frame in which lower bounds of the distances from it are known. The unit of lengths is that of these
/// bounds.
/// @param middle       center of the box of the shape
/// @param axis         axis(i, row): component `row` of the axis SphereCover::axis[i] of the box; an axis is 1 m long
/// @param per_meter    how many units 1 m is
/// @param reach        in units; must allow for the rounding of the center and the axes
/// @param lanes        bit i: whether the result matters for state i
/// @param lowerBounds  returns lower bounds of the distances of four points, in units
template <class Axis, class LowerBounds>
unsigned coverIsFarther(const SphereCover& cover, const Four (&middle)[3], const Axis& axis, float per_meter,
                        const Four& reach, unsigned lanes, const LowerBounds& lowerBounds) {
  const auto bitsWhereGreater = [](const Four& a, const Four& b) {
    return bitsOf(reinterpret_cast<FourCounts>(a > b));
  };
  const unsigned wholly = bitsWhereGreater(lowerBounds(middle), reach + cover.whole * per_meter) & lanes;
  if (wholly == lanes || cover.count[0] * cover.count[1] == 1) return wholly;
  Four steps[2][3], center[3] = {middle[0], middle[1], middle[2]};
  for (std::size_t i = 0; i < 2; ++i) {
    for (std::size_t row = 0; row < 3; ++row) {
      steps[i][row] = axis(i, row) * cover.step[i];
      center[row] -= steps[i][row] * (0.5f * static_cast<float>(cover.count[i] - 1));
    }
  }
  const Four least = reach + cover.radius * per_meter;
  unsigned far = lanes & ~wholly;
  for (std::uint32_t i = 0; i < cover.count[0]; ++i) {
    Four point[3] = {center[0], center[1], center[2]};
    for (std::uint32_t k = 0; k < cover.count[1]; ++k) {
      far &= bitsWhereGreater(lowerBounds(point), least);
      if (far == 0) return wholly;
      for (std::size_t row = 0; row < 3; ++row) point[row] += steps[1][row];
    }
    for (std::size_t row = 0; row < 3; ++row) center[row] += steps[0][row];
  }
  return wholly | far;
}

}  // namespace hgrid
