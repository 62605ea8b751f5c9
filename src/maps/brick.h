// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>

#ifdef __aarch64__
#include <arm_neon.h>
#endif

namespace hgrid {

// A brick has 4 x 4 x 4 cells. They have the indices 0 .. 63 in Morton order. Bits 0, 1, 2 of an index are the lower
// bits of the cell's coordinates x, y, z in the brick. Bits 3, 4, 5 are the upper bits of x, y, z. A set of cells is
// stored as 64 bits.

/// Returns the coordinate of a cell in its brick along an axis, counted in cells: 0 .. 3.
constexpr std::int32_t cellAlong(unsigned cell, int axis) {
  return static_cast<std::int32_t>((cell >> axis & 1u) | (cell >> (axis + 3) & 1u) << 1);
}

/// Returns the number of cells in a set.
inline int bitCount(std::uint64_t cells) {
  cells -= cells >> 1 & 0x5555555555555555;
  cells = (cells & 0x3333333333333333) + (cells >> 2 & 0x3333333333333333);
  return static_cast<int>(((cells + (cells >> 4)) & 0x0f0f0f0f0f0f0f0f) * 0x0101010101010101 >> 56);
}
/// Returns the index of the first cell of a set. The set must not be empty.
inline unsigned firstCell(std::uint64_t cells) { return static_cast<unsigned>(__builtin_ctzll(cells)); }

/// For each axis and each range of coordinates: the set of the cells in this range. sets[axis][first][end] holds the
/// cells whose cellAlong() is at least `first` and less than `end`. `first` and `end` are 0 .. 4.
struct CellRanges {
  std::array<std::array<std::array<std::uint64_t, 5>, 5>, 3> sets{};

  constexpr CellRanges() {
    for (int axis = 0; axis < 3; ++axis) {
      for (int first = 0; first < 5; ++first) {
        for (int end = 0; end < 5; ++end) {
          std::uint64_t set = 0;
          for (unsigned cell = 0; cell < 64; ++cell) {
            const std::int32_t at = cellAlong(cell, axis);
            if (first <= at && at < end) set |= std::uint64_t{1} << cell;
          }
          sets[static_cast<std::size_t>(axis)][static_cast<std::size_t>(first)][static_cast<std::size_t>(end)] = set;
        }
      }
    }
  }
};
inline constexpr CellRanges kCellRanges;

/// Returns the cells of a brick that the interval min .. max along an axis overlaps. Both limits are in cells, relative
/// to the brick's corner.
inline std::uint64_t cellsBetween(int axis, double min, double max) {
  const auto& sets = kCellRanges.sets[static_cast<std::size_t>(axis)];
#ifdef __aarch64__  // computes both limits at once; gcc would turn std::min and std::max into branches
  const float64x2_t ends = vminq_f64(vmaxq_f64(float64x2_t{min, max + 1.0}, vdupq_n_f64(0.0)), vdupq_n_f64(4.0));
  const uint64x2_t numbers = vcvtq_u64_f64(ends);  // NaN becomes 0, as in the code for other processors
  return sets[vgetq_lane_u64(numbers, 0)][vgetq_lane_u64(numbers, 1)];
#else
  const auto number = [](double at) {
    return static_cast<std::size_t>(static_cast<int>(std::min(4.0, std::max(0.0, at))));
  };
  return sets[number(min)][number(max + 1.0)];
#endif
}

}  // namespace hgrid
