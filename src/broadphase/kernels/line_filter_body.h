// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
//
// A quick test that finds the boxes that may touch a line. It tests kWidth boxes at once.
// This is a part of kernels_body.h, which explains the type Simd.
#pragma once

#include "broadphase/kernels/kernels.h"

namespace hgrid {
namespace kernels {
namespace {

/// The values of a line that a quick test needs. The test rejects boxes that do not touch the line. It compares the
/// line and the box on six separating axes (Ericson 2005, 4.4):
///
/// - On the axes x, y and z, it compares the box with the box around the line.
/// - On the three axes that are normal to the line and to a side of the box, it compares the distance of the centers
///   with the sum of the half-widths.
///
/// The test computes in float. It allows for the rounding, so it never rejects a box that touches the line.
///
/// `step` is the vector along the line, scaled so that its largest component is 1. `width` is slightly more than
/// |step|. `slack` [m] contains twice the radius of the line and the allowance for rounding.
struct LineFilter {
  Simd::Lanes min[3], max[3];                              // [m] the box around the line
  Simd::Lanes step[3], twice_from[3], width[3], slack[3];  // twice_from: [m] twice the start of the line
};

inline double magnitude(double value) { return __builtin_fabs(value); }

/// Returns a float that is slightly less than `value`.
inline float floatBelow(double value) {
  const auto nearest = static_cast<float>(value);
  return nearest - static_cast<float>(magnitude(static_cast<double>(nearest))) * 1.2e-7f - 1e-37f;
}
/// Returns a float that is slightly greater than `value`.
inline float floatAbove(double value) { return -floatBelow(-value); }

/// Prepares the quick test for a line.
inline LineFilter filterOf(const Line& line) {
  double length = 0.0, farthest = line.around;
  for (int axis = 0; axis < 3; ++axis) {
    const double step = magnitude(line.step[axis]), from = magnitude(line.from[axis]);
    length = step > length ? step : length;
    farthest = from + step > farthest ? from + step : farthest;
  }
  const double scale = length > 1e-30 ? 1.0 / length : 0.0;
  LineFilter filter;
  double width[3];
  for (int axis = 0; axis < 3; ++axis) {
    const double step = line.step[axis] * scale;
    width[axis] = magnitude(step) * 1.00001 + 1e-35;  // allows for the rounding of denormal numbers, as 1e-38 below
    const double ends[2] = {line.from[axis], line.from[axis] + line.step[axis]};
    const int highest = line.step[axis] > 0.0 ? 1 : 0;  // an index, because a branch would be mispredicted
    filter.min[axis] = Simd::lanesOf(floatBelow(ends[1 - highest] - line.around));
    filter.max[axis] = Simd::lanesOf(floatAbove(ends[highest] + line.around));
    filter.step[axis] = Simd::lanesOf(static_cast<float>(step));
    filter.width[axis] = Simd::lanesOf(static_cast<float>(width[axis]));
    filter.twice_from[axis] = Simd::lanesOf(static_cast<float>(2.0 * line.from[axis]));
  }
  for (int i = 0; i < 3; ++i) {
    const double across = width[(i + 1) % 3] + width[(i + 2) % 3];
    // Sums of such large coordinates may exceed the range of float. Then this axis rejects no box.
    const bool sane = farthest < 1e30;
    filter.slack[i] = Simd::lanesOf(sane ? static_cast<float>((2.0 * line.around + 2e-5 * farthest) * across + 1e-38)
                                         : __builtin_inff());
  }
  return filter;
}

/// The extents of kWidth boxes along x, y or z.
struct Extents {
  Simd::Lanes away, size;  // [m] twice the distance of the centers from the line's start, and twice the half-widths
  Simd::Mask within;       // whether the boxes overlap the box around the line on this axis
};

inline Extents extentsOf(const LineFilter& filter, int axis, const Columns& boxes, std::uint32_t position) {
  const float* const bounds = boxes.bounds + static_cast<std::size_t>(axis) * boxes.stride + position;
  const Simd::Lanes min = Simd::lanesAt(bounds), max = Simd::lanesAt(bounds + 3 * boxes.stride);
  return {Simd::minus(Simd::plus(min, max), filter.twice_from[axis]), Simd::minus(max, min),
          Simd::both(Simd::notGreater(min, filter.max[axis]), Simd::notGreater(filter.min[axis], max))};
}

/// Tests boxes on the axis that is normal to the line and to coordinate axis i. The other two coordinate axes are j and
/// k. For each box, the result says whether the distance of its center from the line, measured on the tested axis, is
/// at most the sum of the half-widths.
inline Simd::Mask onAxis(const LineFilter& filter, int i, int j, int k, const Extents& at_j, const Extents& at_k) {
  const Simd::Lanes apart = Simd::timesMinus(filter.step[j], at_k.away, Simd::times(filter.step[k], at_j.away));
  const Simd::Lanes reach =
      Simd::timesPlus(at_j.size, filter.width[k], Simd::timesPlus(at_k.size, filter.width[j], filter.slack[i]));
  return Simd::notGreater(Simd::size(apart), reach);
}

/// Tests the boxes from `position` on. Bit k of the result is 1 if the box at `position` + k may touch the line. Bit k
/// is 0 for k >= count and for k >= kWidth.
inline __attribute__((always_inline)) std::uint32_t onLine(const LineFilter& filter, const Columns& boxes,
                                                           std::uint32_t position, std::uint32_t count) {
  const Extents x = extentsOf(filter, 0, boxes, position), y = extentsOf(filter, 1, boxes, position),
                z = extentsOf(filter, 2, boxes, position);
  const Simd::Mask around = Simd::both(x.within, Simd::both(y.within, z.within));
  const Simd::Mask on = Simd::both(onAxis(filter, 0, 1, 2, y, z),
                                   Simd::both(onAxis(filter, 1, 2, 0, z, x), onAxis(filter, 2, 0, 1, x, y)));
  return Simd::bitsOf(Simd::both(around, on), count);
}

}  // namespace
}  // namespace kernels
}  // namespace hgrid
