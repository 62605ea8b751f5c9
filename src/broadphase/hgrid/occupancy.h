// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "broadphase/kernels/kernels.h"

namespace hgrid {

/// Says where in space a layer certainly has no boxes.
///
/// A cube around the bounds of all levels is divided into 32 x 32 x 32 coarse cells, with one bit for each cell. The
/// bit is 1 if the bounds of a level overlap the cell (a bit array of occupied cells, Ericson 2005, 7.1.5). In a layer
/// with several regions, most of space may be empty. Then a few bits answer a query.
///
/// The coarse cell of coordinate v is trunc(clamp(v * inverse - origin, 0, 31)), computed in double. Each step is
/// monotone in v. So two boxes that overlap have a common coarse cell.
class Occupancy {
 public:
  /// Allocates the memory that set() needs.
  void reserve() {
    rows_.reserve(kRows);
    near_rows_.reserve(kRows);
  }
  /// Returns whether reserve() was called.
  bool isReserved() const { return rows_.capacity() >= kRows && near_rows_.capacity() >= kRows; }
  /// From now on, all space may have boxes. Allocates nothing.
  void clear() { rows_.clear(); }
  /// Computes the bits for these levels. If most cells are occupied, works like clear(), because then the bits are of
  /// no use. Allocates nothing after reserve().
  void set(const std::vector<kernels::Level>& levels);

  /// Returns false only if no box of the layer overlaps `box`.
  bool mayOverlap(const kernels::Box& box) const {
    if (rows_.empty()) return true;
    std::uint32_t low[3], high[3];
    for (int axis = 0; axis < 3; ++axis) {
      low[axis] = cellAt(cells(static_cast<double>(box.min[axis]), axis));
      high[axis] = cellAt(cells(static_cast<double>(box.max[axis]), axis));
    }
    return isOccupied(low, high);
  }
  /// Returns false only if no box of the layer is within `distance` [m] of a point.
  bool mayBeNear(const double* point, double distance) const {
    if (rows_.empty()) return true;
    std::uint32_t low[3], high[3];
    for (int axis = 0; axis < 3; ++axis) {
      const double cell = cells(point[axis], axis), reach = distance * inverse_ + slack_;
      low[axis] = cellAt(cell - reach);
      high[axis] = cellAt(cell + reach);
    }
    return isOccupied(low, high);
  }
  /// Returns false only if no box of the layer is within the radius of a line.
  bool mayTouch(const kernels::Line& line) const { return rows_.empty() || isOnLine(line); }

  /// Returns the allocated memory [bytes].
  std::size_t bytes() const { return (rows_.capacity() + near_rows_.capacity()) * sizeof(std::uint32_t); }

 private:
  static constexpr std::uint32_t kAcross = 32, kRows = kAcross * kAcross;
  static constexpr double kLast = 31.0;  // index of the last cell on each axis

  static std::uint32_t cellAt(double cell) {
    cell = cell > 0.0 ? cell : 0.0;  // 0 if `cell` is NaN
    return static_cast<std::uint32_t>(static_cast<std::int32_t>(cell < kLast ? cell : kLast));
  }
  double cells(double value, int axis) const { return value * inverse_ - origin_[axis]; }
  /// Returns whether one of the cells low .. high is occupied.
  bool isOccupied(const std::uint32_t* low, const std::uint32_t* high) const {
    std::uint32_t found = 0;
    for (std::uint32_t z = low[2]; z <= high[2]; ++z) {
      for (std::uint32_t y = low[1]; y <= high[1]; ++y) found |= rows_[z * kAcross + y];
    }
    return (found >> low[0] << low[0] << (31 - high[0])) != 0;
  }
  bool isOnLine(const kernels::Line& line) const;

  double inverse_ = 0.0, origin_[3] = {};  // [1/m] and [cells], as in kernels::Grid
  double slack_ = 0.0;                     // [cells] allows for the rounding of cells
  // Each number holds the bits of one row of cells along x. Rows follow each other along y, then z. If there are none,
  // all space may have boxes.
  std::vector<std::uint32_t> rows_;
  // Has as many numbers as rows_, with one bit for each cell as well. Here, the bit is 1 if one of eight cells is
  // occupied: the cell itself, or a cell whose index is larger by one on x, y, z or several of these axes. The cell
  // after the last cell of an axis is its first cell.
  std::vector<std::uint32_t> near_rows_;
};

}  // namespace hgrid
