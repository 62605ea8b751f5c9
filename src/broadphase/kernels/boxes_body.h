// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
//
// Boxes that overlap a box.
// Part of kernels_body.h, which says what Simd is.
#pragma once

#include "broadphase/kernels/kernels.h"
#include "broadphase/kernels/output_body.h"

namespace hgrid {
namespace kernels {
namespace {

inline std::int32_t cellOf(float value, const Grid& grid, int axis) {
  float cell = value * grid.inverse[axis] - grid.origin[axis];
  cell = cell > 0.0f ? cell : 0.0f;
  cell = cell < grid.last[axis] ? cell : grid.last[axis];
  return static_cast<std::int32_t>(cell);
}

void overlapping(const Level* level, const Box* box, PositionSink* sink) {
  const Level l = *level;
  const Grid& grid = l.grid;
  std::int32_t low[3], high[3];
  for (int axis = 0; axis < 3; ++axis) {
    low[axis] = cellOf(box->min[axis] - l.reach[axis], grid, axis);
    high[axis] = cellOf(box->max[axis], grid, axis);
  }
  const Simd::Box query = Simd::boxOf(*box);
  Output<std::uint32_t> found(sink);
  const std::int32_t first = low[grid.axes[0]], last = high[grid.axes[0]];
  for (std::int32_t z = low[grid.axes[2]]; z <= high[grid.axes[2]]; ++z) {
    for (std::int32_t y = low[grid.axes[1]]; y <= high[grid.axes[1]]; ++y) {
      const std::int32_t row = z * grid.slab + y * grid.row;
      const std::uint32_t end = l.start[row + last + 1];
      for (std::uint32_t j = l.start[row + first]; j < end; j += Simd::kWidth) {
        found.wrote(Simd::storePositions(found.room(), j, Simd::overlaps(query, l, j, end - j)));
      }
    }
  }
  found.close();
}

}  // namespace
}  // namespace kernels
}  // namespace hgrid
