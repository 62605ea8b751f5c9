// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#include "broadphase/hgrid/cell_costs.h"

#include <algorithm>
#include <cmath>
#include <cstdint>

#include "geometry/rounding.h"

namespace hgrid {
namespace {

// Costs [ns] in the estimates below. They were measured on one machine. Only their ratios matter.
constexpr double kPerBox = 10.0, kPerFollower = 0.375;               // a follower: a later box of the same row
constexpr double kPerBoxInOneRow = 4.0, kPerFollowerInOneRow = 0.8;  // if all cells are one row
constexpr double kPerRow = 3.0, kPerAskingBox = 4.0, kPerAskedRow = 6.0, kPerTest = 3.0, kPerCell = 0.15;
// If boxes extend over several cells, the estimate is too low by this factor, because it counts only one more row on
// each side. The value was measured.
constexpr double kSmallCellFactor = 1.8;
constexpr double kMostCellsOnAxis = 16777214.0;  // Grid::last must be exact as a float
constexpr double kMostCellsAlongBox = 12.0;      // along a row, at most so many cells per longest box
constexpr double kLanes = 8.0;  // boxes per test; one value for all instruction sets, so that all make the same plan

/// Returns how many cells cover a length. Converts to an integer, because std::floor() is slower.
double cellsAlong(double length, double edge) {
  return static_cast<double>(static_cast<std::int64_t>(std::min(length / edge, 1e15))) + 1.0;
}

}  // namespace

Cells cellsOf(const Census& level, const Window& window, const AxisOrder& axes, double edge_y, double edge_z,
              double least_edge) {
  const auto [x, y, z] = axes;
  Cells cells;
  cells.axes = axes;
  cells.edge[y] = edge_y;
  cells.edge[z] = edge_z;
  cells.count[y] = cellsAlong(window.length(y), edge_y);
  cells.count[z] = cellsAlong(window.length(z), edge_z);
  const double rows = cells.count[y] * cells.count[z];
  const double most = window.mostCells(level.boxes);
  if (rows > most || std::max(cells.count[y], cells.count[z]) > kMostCellsOnAxis) return cells;
  // If fewer than two cells per row are allowed, the edge is longer than the window, so a row has one cell.
  const double along = most / rows - 1.0;
  cells.edge[x] = std::max(least_edge, window.length(x) / (along < 1.0 ? 0.5 : std::min(along, kMostCellsOnAxis)));
  if (!(cells.edge[x] > 0.0)) cells.edge[x] = 1.0;
  cells.count[x] = cellsAlong(window.length(x), cells.edge[x]);

  const auto chance = [&](std::size_t axis, double length) {
    return cells.count[axis] > 1.0 ? std::min(1.0, length / cells.edge[axis]) : 0.0;
  };
  const double up_y = chance(y, level.mean(y)), up_z = chance(z, level.mean(z)), down_y = chance(y, level.largest[y]);
  const double other_rows = up_y + up_z * (1.0 + up_y + down_y);
  const double per_meter = level.boxes / rows / std::max(window.length(x), cells.edge[x]);
  const double own = per_meter * (level.mean(x) + 0.5 * cells.edge[x]);
  const double other = per_meter * (level.mean(x) + level.largest[x] + cells.edge[x]);
  const double tests = 1.0 + std::min(other, level.boxes) / kLanes;
  const double per_box =
      kPerBox + kPerFollower * std::min(own, level.boxes) + other_rows * (kPerRow + kPerTest * tests);
  cells.cost = level.boxes * per_box + kPerCell * cells.count[x] * rows;
  return cells;
}

Cells bestCellsOf(const Census& level, const Window& window) {
  const auto [x, y, z] = window.axes;
  // Along the rows, cells are shorter than across, because a range of cells can begin at any cell of a row.
  const auto withEdge = [&](double across) {
    return cellsOf(level, window, window.axes, across, across, across / kMostCellsAlongBox);
  };
  const double widest = std::max({level.largest[y], level.largest[z], kLeastLength});
  Cells best;
  for (const double factor : {0.25, 0.35, 0.5, 0.7, 1.0, 1.4, 2.0, 3.0, 4.0, 6.0, 10.0, 20.0, 50.0, 200.0, 1e3, 1e4}) {
    Cells cells = withEdge(factor * widest);
    if (factor < 1.0) cells.cost *= kSmallCellFactor;
    if (cells.cost < best.cost) best = cells;
  }
  // The boxes may be so sparse that all these edges give too many cells. Then the number of rows determines the edge.
  if (!std::isfinite(best.cost)) {
    const double longest = std::max({window.length(y), window.length(z), kLeastLength});
    best = withEdge(2.0 * longest / std::sqrt(window.mostCells(level.boxes)));
  }
  return best;
}

Cells oneRowOf(const Census& all, const BoxSample& sample, const Window& window, double most_cost) {
  const auto costOf = [&all](double followers) {
    return all.boxes * (kPerBoxInOneRow + kPerFollowerInOneRow * followers);
  };
  Cells best;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    Cells cells;
    cells.axes = rowsAlong(axis);
    for (std::size_t i = 0; i < 3; ++i) cells.edge[i] = 1.0 + 2.0 * window.length(i);  // longer than the window
    cells.count.fill(1.0);
    const double length = window.length(axis);
    const double most = std::min(window.mostCells(all.boxes), kMostCellsOnAxis) - 1.0;
    cells.edge[axis] = std::max({all.largest[axis] / kMostCellsAlongBox, length / most, kLeastLength});
    cells.count[axis] = cellsAlong(length, cells.edge[axis]);
    const double reach = all.mean(axis) + 0.5 * cells.edge[axis];
    if (costOf(sample.leastFollowers(axis, reach)) > most_cost) continue;
    cells.followers = sample.followers(axis, reach);
    cells.cost = costOf(cells.followers) + kPerCell * cells.count[axis];
    if (cells.cost < best.cost) best = cells;
  }
  return best;
}

double costOfAsking(const Census& asking, const Census& asked, const Cells& cells) {
  const auto [x, y, z] = cells.axes;
  double rows = 1.0;
  for (const std::size_t axis : {y, z}) {
    rows *= std::min(cells.count[axis], 1.0 + (asking.mean(axis) + asked.largest[axis]) / cells.edge[axis]);
  }
  const double along =
      std::min(1.0, (asking.mean(x) + asked.largest[x] + cells.edge[x]) / (cells.edge[x] * cells.count[x]));
  const double candidates = asked.boxes * along / (cells.count[y] * cells.count[z]);
  return asking.boxes * (kPerAskingBox + rows * (kPerAskedRow + kPerTest * (1.0 + candidates / kLanes)));
}

}  // namespace hgrid
