// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "geometry/four_lanes.h"

namespace hgrid {

/// Returns the square of the gap, in half edges, between the center of a cell and another cell along an axis.
/// @param cells  how many cells the other one is away
constexpr std::uint16_t gapSquared(std::int32_t cells) {
  const std::int32_t gap = cells == 0 ? 0 : 2 * (cells < 0 ? -cells : cells) - 1;
  return static_cast<std::uint16_t>(gap * gap);
}

/// For four points, the nearest cells of a box of equal cubes. Turns lower bounds of distances from the centers of the
/// cells into lower bounds of distances from the points. The unit of all lengths is the edge of a cell.
class NearCells {
 public:
  using FourInts = std::int32_t __attribute__((vector_size(16)));

  /// @param points  for each axis: coordinates relative to the lowest corner of the box
  /// @param counts  number of cells along each axis
  NearCells(const Four (&points)[3], const std::array<float, 3>& counts) {
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const Four most = allFour(counts[axis] - 0.5f);
      const Four within = least(greatest(points[axis], allFour(0.0f)), most);
      const Four away = points[axis] - within;
      cells_[axis] = __builtin_convertvector(within, FourInts);
      const Four off = within - (__builtin_convertvector(cells_[axis], Four) + 0.5f);
      outside_ += away * away;
      off_center_ += off * off;
    }
  }

  /// Returns the cells as numbers along an axis, from 0 on.
  const FourInts& along(std::size_t axis) const { return cells_[axis]; }

  /// Returns lower bounds of the distances from the points to something that is within the box of cells, and at least
  /// half a cell from its border.
  /// @param from_centers  lower bounds of the distances from the centers of the cells
  Four lowerBounds(const Four& from_centers) const {
    const Four inside = greatest(from_centers - squareRoot(off_center_), allFour(0.0f));
    // For a point outside the box, the segment to the nearest point of the box and the segment from there to anything
    // in the box form an angle of at least 90 degrees.
    return squareRoot(outside_ + inside * inside) * (1.0f - kRounding) - kRounding;
  }

 private:
  static constexpr float kRounding = 2e-6f;  // relative, and in edges: more than the rounding errors of a bound

  FourInts cells_[3];
  Four outside_{}, off_center_{};  // squares of distances: to the box, and from there to the center of the cell
};

}  // namespace hgrid
