// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
//
// Finds the boxes that overlap a given box.
// This is a part of kernels_body.h, which explains the type Simd.
#pragma once

#include "broadphase/kernels/kernels.h"
#include "broadphase/kernels/levels_body.h"
#include "broadphase/kernels/output_body.h"

namespace hgrid {
namespace kernels {
namespace {

/// Returns the index, along one axis, of the cell that contains a coordinate [m].
inline std::int32_t cellOf(float value, const Grid& grid, int axis) {
  float cell = value * grid.inverse[axis] - grid.origin[axis];
  cell = cell > 0.0f ? cell : 0.0f;
  cell = cell < grid.last[axis] ? cell : grid.last[axis];
  return static_cast<std::int32_t>(cell);
}

/// Finds the boxes in a range of positions that overlap a box.
inline void searchRange(const Level& level, const Simd::Box& query, PositionRange range, Output<std::uint32_t>& found) {
  for (std::uint32_t j = range.begin; j < range.end; j += Simd::kWidth) {
    found.wrote(Simd::storePositions(found.room(), j, Simd::overlaps(query, level, j, range.end - j)));
  }
}

/// Finds the boxes of one level that overlap a box. `query` holds the same box as `box`, in SIMD registers.
inline void searchLevel(const Level& level, const Box& box, const Simd::Box& query, Output<std::uint32_t>& found) {
  const Level l = level;
  const Grid& grid = l.grid;
  std::int32_t low[3], high[3];
  for (int axis = 0; axis < 3; ++axis) {
    low[axis] = cellOf(box.min[axis] - l.reach[axis], grid, axis);
    high[axis] = cellOf(box.max[axis], grid, axis);
  }
  const std::int32_t first = low[grid.axes[0]], last = high[grid.axes[0]];
  for (std::int32_t z = low[grid.axes[2]]; z <= high[grid.axes[2]]; ++z) {
    for (std::int32_t y = low[grid.axes[1]]; y <= high[grid.axes[1]]; ++y) {
      const std::int32_t row = z * grid.slab + y * grid.row;
      searchRange(l, query, {l.start[row + first], l.start[row + last + 1]}, found);
    }
  }
}

void overlapping(const LevelSet* set, const Box* box, PositionSink* sink) {
  const Box b = *box;
  const Simd::Box query = Simd::boxOf(b);
  const Level* const levels = set->levels;
  Output<std::uint32_t> found(sink);
  visitLeaves(
      *set,
      [&query](const Columns& bounds, std::uint32_t j, std::uint32_t count) {
        return Simd::overlaps(query, bounds, j, count);
      },
      [&](std::uint32_t number) {
        if (set->per_leaf == 0) return searchLevel(levels[number], b, query, found);
        searchRange(*levels, query, rangeOf(*set, number), found);
      });
  found.close();
}

void reaching(const LevelSet* set, const Box* box, PositionSink* sink) {
  const Simd::Box query = Simd::boxOf(*box);
  Output<std::uint32_t> found(sink);
  visitLeaves(
      *set,
      [&query](const Columns& bounds, std::uint32_t j, std::uint32_t count) {
        return Simd::overlaps(query, bounds, j, count);
      },
      [&found](std::uint32_t number) {
        *found.room() = number;
        found.wrote(found.room() + 1);
      });
  found.close();
}

}  // namespace
}  // namespace kernels
}  // namespace hgrid
