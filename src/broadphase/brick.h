// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

#include <array>
#include <cstdint>

namespace hgrid {

// Cells of a brick of 4 x 4 x 4, numbered in Morton order: bits 0, 1, 2 of a number are the lower bits of x, y, z, bits
// 3, 4, 5 the upper ones. A set of cells is 64 bits.

/// Where a cell is along an axis, 0 .. 3.
constexpr std::int32_t cellAlong(unsigned cell, int axis) {
  return static_cast<std::int32_t>((cell >> axis & 1u) | (cell >> (axis + 3) & 1u) << 1);
}

/// How many cells a set has.
inline int bitCount(std::uint64_t cells) {
  cells -= cells >> 1 & 0x5555555555555555;
  cells = (cells & 0x3333333333333333) + (cells >> 2 & 0x3333333333333333);
  return static_cast<int>(((cells + (cells >> 4)) & 0x0f0f0f0f0f0f0f0f) * 0x0101010101010101 >> 56);
}
/// The first cell of a set that is not empty.
inline unsigned firstCell(std::uint64_t cells) { return static_cast<unsigned>(__builtin_ctzll(cells)); }

/// By axis, first and last: the cells between two positions along the axis; none if the first is after the last.
struct CellRanges {
  std::array<std::array<std::array<std::uint64_t, 4>, 4>, 3> sets{};

  constexpr CellRanges() {
    for (int axis = 0; axis < 3; ++axis) {
      for (int first = 0; first < 4; ++first) {
        for (int last = 0; last < 4; ++last) {
          std::uint64_t set = 0;
          for (unsigned cell = 0; cell < 64; ++cell) {
            const std::int32_t at = cellAlong(cell, axis);
            if (first <= at && at <= last) set |= std::uint64_t{1} << cell;
          }
          sets[static_cast<std::size_t>(axis)][static_cast<std::size_t>(first)][static_cast<std::size_t>(last)] = set;
        }
      }
    }
  }
};
inline constexpr CellRanges kCellRanges;

/// The cells of a brick that have a part of min .. max on an axis, in cells from the brick's corner.
inline std::uint64_t cellsBetween(int axis, double min, double max) {
  if (!(max >= 0.0 && min <= 4.0)) return 0;
  const auto number = [](double at) { return static_cast<std::size_t>(at > 0.0 ? (at < 3.0 ? at : 3.0) : 0.0); };
  return kCellRanges.sets[static_cast<std::size_t>(axis)][number(min)][number(max)];
}

}  // namespace hgrid
