// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <limits>

#include "broadphase/hgrid/box_sample.h"

namespace hgrid {

// This file plans the cells of levels, and estimates how long searches with these cells take. A vector has one value
// per axis.

constexpr double kMostCellsPerBox = 1.0;  ///< must be an integer for CellPlan::mostCells()

/// Statistics of some boxes, for example those of one size class.
struct Census {
  using Vector = std::array<double, 3>;

  double boxes = 0.0;         ///< number of boxes
  Vector largest{}, total{};  ///< [m] longest side, and sum of all sides

  void add(const Vector& sides) {
    boxes += 1.0;
    for (std::size_t i = 0; i < 3; ++i) {
      largest[i] = std::max(largest[i], sides[i]);
      total[i] += sides[i];
    }
  }
  void add(const Census& other) {
    boxes += other.boxes;
    for (std::size_t i = 0; i < 3; ++i) {
      largest[i] = std::max(largest[i], other.largest[i]);
      total[i] += other.total[i];
    }
  }
  double mean(std::size_t axis) const { return boxes > 0.0 ? total[axis] / boxes : 0.0; }
  Vector mean() const { return {mean(0), mean(1), mean(2)}; }
};

/// The order of the axes. Rows of cells lie along axes[0]. Rows that follow each other along axes[1] form a slab. Slabs
/// follow each other along axes[2].
using AxisOrder = std::array<std::size_t, 3>;

/// Returns the order in which rows lie along `axis`.
constexpr AxisOrder rowsAlong(std::size_t axis) { return {axis, (axis + 1) % 3, (axis + 2) % 3}; }

/// The window: the part of space [m] that is divided into cells. It contains the minimum corners of nearly all boxes.
struct Window {
  std::array<double, 3> low{}, high{};
  AxisOrder axes{0, 1, 2};
  double spare_cells = 0.0;
  double length(std::size_t axis) const { return high[axis] - low[axis]; }
  double mostCells(double boxes) const { return kMostCellsPerBox * boxes + spare_cells; }
};

/// The cells of a level: edge [m] and count for each axis, and the estimated cost [ns] to find the level's pairs.
struct Cells {
  AxisOrder axes{0, 1, 2};
  std::array<double, 3> edge{};
  std::array<double, 3> count{};
  double followers = 0.0;  ///< only of oneRowOf(): estimated number of boxes that follow a box
  double cost = std::numeric_limits<double>::infinity();
};

/// Plans the cells of a level, and estimates the cost to find its pairs. If there would be too many cells, the cost is
/// infinite.
/// @param edge_y, edge_z  [m] edges of a cell along axes[1] and axes[2]
/// @param least_edge      [m] lower limit of the edge of a cell along the rows
Cells cellsOf(const Census& level, const Window& window, const AxisOrder& axes, double edge_y, double edge_z,
              double least_edge);
/// Plans the best cells for a level. Across the rows, both edges of a cell are equal.
Cells bestCellsOf(const Census& level, const Window& window);
/// Plans one row of cells for all boxes, along the cheapest axis. A search then tests each box only against the boxes
/// that begin before it ends, as in a sweep along one axis (Ericson 2005, 7.5). The cost is estimated from the sample,
/// so it also holds for boxes that are spread unevenly. Returns an infinite cost if a row clearly costs more
/// than `most_cost`.
Cells oneRowOf(const Census& all, const BoxSample& sample, const Window& window, double most_cost);
/// Estimates the cost [ns] to find the pairs of the boxes `asking` with the boxes `asked` of another level.
/// @param cells  the cells of the boxes `asked`
double costOfAsking(const Census& asking, const Census& asked, const Cells& cells);

}  // namespace hgrid
