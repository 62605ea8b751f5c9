// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#include "broadphase/hgrid/cell_plan.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

#include "broadphase/hgrid/box_sample.h"
#include "geometry/infinity.h"

namespace hgrid {
namespace {

using Vector = std::array<double, 3>;

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
constexpr std::size_t kFewInOneRow = 2048;   // boxes; so few may share a row, even if queries must test all its leaves
constexpr std::size_t kWorthSampling = 256;  // boxes; in a smaller region, the window contains all boxes
constexpr double kMostCellsPerBox = 1.0;     // must be an integer for CellPlan::mostCells()

/// Statistics of the boxes of one size class, or of several size classes together.
struct Census {
  double boxes = 0.0;         // number of boxes
  Vector largest{}, total{};  // [m] per axis: longest side, and sum of all sides

  void add(const Census& other) {
    boxes += other.boxes;
    for (std::size_t i = 0; i < 3; ++i) {
      largest[i] = std::max(largest[i], other.largest[i]);
      total[i] += other.total[i];
    }
  }
  double mean(std::size_t axis) const { return total[axis] / boxes; }
  Vector mean() const { return {mean(0), mean(1), mean(2)}; }
};

/// The window: the part of space [m] that is divided into cells. It contains the minimum corners of nearly all boxes.
/// Rows of cells lie along axes[0]. Rows that follow each other along axes[1] form a slab. Slabs follow each other
/// along axes[2].
struct Window {
  Vector low{}, high{};
  std::array<std::size_t, 3> axes{0, 1, 2};
  double spare_cells = 0.0;
  double length(std::size_t axis) const { return high[axis] - low[axis]; }
  double mostCells(double boxes) const { return kMostCellsPerBox * boxes + spare_cells; }
};

/// The cells of a level: edge [m] and count for each axis, and the estimated cost [ns] to find the level's pairs.
/// `axes` is as in Window.
struct Cells {
  std::array<std::size_t, 3> axes{0, 1, 2};
  Vector edge{};
  std::array<double, 3> count{};
  double followers = 0.0;  // only of oneRowOf(): estimated number of boxes that follow a box
  double cost = std::numeric_limits<double>::infinity();
};

double cellsAlong(double length, double edge) { return std::floor(length / edge) + 1.0; }

/// Plans the cells of a level and estimates the cost to find its pairs. Along the rows, cells are shorter than
/// `across`, because a range of cells can begin at any cell of a row.
/// @param across  [m] edge of a cell on the two axes perpendicular to the rows
Cells cellsOf(const Census& level, const Window& window, double across) {
  const auto [x, y, z] = window.axes;
  Cells cells;
  cells.axes = window.axes;
  cells.edge[y] = cells.edge[z] = across;
  cells.count[y] = cellsAlong(window.length(y), across);
  cells.count[z] = cellsAlong(window.length(z), across);
  const double rows = cells.count[y] * cells.count[z];
  const double most = window.mostCells(level.boxes);
  // If there would be too many cells, the cost remains infinite.
  if (rows > most || std::max(cells.count[y], cells.count[z]) > kMostCellsOnAxis) return cells;
  // If fewer than two cells per row are allowed, the edge is longer than the window, so a row has one cell.
  const double along = most / rows - 1.0;
  cells.edge[x] =
      std::max(across / kMostCellsAlongBox, window.length(x) / (along < 1.0 ? 0.5 : std::min(along, kMostCellsOnAxis)));
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
  const double widest = std::max({level.largest[y], level.largest[z], 1e-30});
  Cells best;
  for (const double factor : {0.25, 0.35, 0.5, 0.7, 1.0, 1.4, 2.0, 3.0, 4.0, 6.0, 10.0, 20.0, 50.0, 200.0, 1e3, 1e4}) {
    Cells cells = cellsOf(level, window, factor * widest);
    if (factor < 1.0) cells.cost *= kSmallCellFactor;
    if (cells.cost < best.cost) best = cells;
  }
  // The boxes may be so sparse that all these edges give too many cells. Then the number of rows determines the edge.
  if (!std::isfinite(best.cost)) {
    const double longest = std::max({window.length(y), window.length(z), 1e-30});
    best = cellsOf(level, window, 2.0 * longest / std::sqrt(window.mostCells(level.boxes)));
  }
  return best;
}

/// Plans one row of cells for all boxes, along the cheapest axis. A search then tests each box only against the boxes
/// that begin before it ends, as in a sweep along one axis (Ericson 2005, 7.5). The cost is estimated from the sample,
/// so it also holds for boxes that are spread unevenly.
Cells oneRowOf(const Census& all, const BoxSample& sample, const Window& window) {
  Cells best;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    Cells cells;
    cells.axes = {axis, (axis + 1) % 3, (axis + 2) % 3};
    for (std::size_t i = 0; i < 3; ++i) cells.edge[i] = 1.0 + 2.0 * window.length(i);  // longer than the window
    cells.count.fill(1.0);
    const double length = window.length(axis);
    const double most = std::min(window.mostCells(all.boxes), kMostCellsOnAxis) - 1.0;
    cells.edge[axis] = std::max({all.largest[axis] / kMostCellsAlongBox, length / most, 1e-30});
    cells.count[axis] = cellsAlong(length, cells.edge[axis]);
    cells.followers = sample.followers(axis, all.mean(axis) + 0.5 * cells.edge[axis]);
    cells.cost = all.boxes * (kPerBoxInOneRow + kPerFollowerInOneRow * cells.followers) + kPerCell * cells.count[axis];
    if (cells.cost < best.cost) best = cells;
  }
  return best;
}

/// Estimates the cost [ns] to find the pairs of the boxes `asking` with the boxes `asked` of a coarser level.
double costOfAsking(const Census& asking, const Census& asked, const Cells& cells, const Window& window) {
  const auto [x, y, z] = window.axes;
  double rows = 1.0;
  for (const std::size_t axis : {y, z}) {
    rows *= std::min(cells.count[axis], 1.0 + (asking.mean(axis) + asked.largest[axis]) / cells.edge[axis]);
  }
  const double along =
      std::min(1.0, (asking.mean(x) + asked.largest[x] + cells.edge[x]) / (cells.edge[x] * cells.count[x]));
  const double candidates = asked.boxes * along / (cells.count[y] * cells.count[z]);
  return asking.boxes * (kPerAskingBox + rows * (kPerAskedRow + kPerTest * (1.0 + candidates / kLanes)));
}

/// Computes the window. On each axis, it contains the middle 98 % of the minimum corners, and it extends beyond each
/// end by half of their length. It never extends beyond the outermost corner. So one box that is a million meters away
/// does not make the cells of the others a thousand times too large.
Window windowOf(const BoxSample& sample, const Vector& lower, const Vector& upper) {
  Window window;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const double low = sample.low(axis), high = sample.high(axis), beyond = 0.5 * (high - low);
    window.low[axis] = std::max(lower[axis], low - beyond);
    window.high[axis] = std::min(upper[axis], high + beyond);
  }
  return window;
}

/// Chooses the axes of the window. Rows lie along the axis on which the window is longest, measured in mean box sides.
/// This is x unless another axis is clearly longer.
std::array<std::size_t, 3> axesFor(const Window& window, const Census& all) {
  constexpr double kClearly = 2.0;
  const auto length = [&](std::size_t axis) { return window.length(axis) / std::max(all.mean(axis), 1e-30); };
  const std::size_t other = length(2) > length(1) ? 2 : 1;
  if (!(length(other) > kClearly * length(0))) return {0, 1, 2};
  return other == 1 ? std::array<std::size_t, 3>{1, 0, 2} : std::array<std::size_t, 3>{2, 0, 1};
}

/// Appends a level with these cells to the plan.
void append(CellPlan& plan, const Census& census, const Window& window, const Cells& cells, double side) {
  const std::size_t number = plan.levels++;
  kernels::Grid& grid = plan.grids[number];
  for (std::size_t i = 0; i < 3; ++i) {
    grid.inverse[i] = static_cast<float>(1.0 / std::clamp(cells.edge[i], 1e-30, 1e30));
    grid.origin[i] = static_cast<float>(window.low[i] * static_cast<double>(grid.inverse[i]));
    grid.last[i] = static_cast<float>(cells.count[i] - 1.0);
    plan.largest[number][i] = static_cast<float>(census.largest[i]);
    plan.mean_sides[number][i] = static_cast<float>(census.mean(i));
  }
  const auto [x, y, z] = cells.axes;
  grid.row = static_cast<std::int32_t>(cells.count[x]);
  grid.slab = grid.row * static_cast<std::int32_t>(cells.count[y]);
  grid.rows = static_cast<std::int32_t>(cells.count[y] * cells.count[z]);
  grid.steps[x] = 1;
  grid.steps[y] = grid.row;
  grid.steps[z] = grid.slab;
  for (std::size_t i = 0; i < 3; ++i) grid.axes[i] = static_cast<std::int32_t>(cells.axes[i]);
  plan.sides[number] = static_cast<float>(side);
}

/// The statistics of some boxes.
struct BoxStatistics {
  static constexpr std::size_t kSizes = GridScale::kLevels + 1;

  std::array<Census, kSizes> sizes;  // per size class, smallest boxes first
  Vector lower, upper;               // [m] bounds of the minimum corners
};

BoxStatistics statisticsOf(const std::vector<Aabb>& boxes, const ProxyId* ids, std::size_t count, double finest_edge) {
  BoxStatistics statistics;
  Vector &lower = statistics.lower, &upper = statistics.upper;
  lower.fill(kInfinity);
  upper.fill(-kInfinity);
  for (std::size_t k = 0; k < count; ++k) {
    const Aabb& box = boxes[ids[k]];
    double edge = finest_edge;
    std::size_t number = 0;
    for (const double side = longestSide(box); number < GridScale::kLevels && side > edge; ++number) {
      edge *= GridScale::kRatio;
    }
    Census& level = statistics.sizes[number];
    level.boxes += 1.0;
    for (std::size_t i = 0; i < 3; ++i) {
      const double low = box.min[static_cast<Eigen::Index>(i)];
      const double length = box.max[static_cast<Eigen::Index>(i)] - low;
      level.largest[i] = std::max(level.largest[i], length);
      level.total[i] += length;
      lower[i] = std::min(lower[i], low);
      upper[i] = std::max(upper[i], low);
    }
  }
  return statistics;
}

/// Plans the levels, the coarsest first, and returns the estimated cost [ns] to find all pairs.
///
/// Goes through the size classes from the coarsest to the finest. Each class either shares the level of the class
/// before, or has a level of its own. The boxes of a level of its own are tested against the coarser levels. The
/// cheaper way is taken.
double planLevels(CellPlan& plan, const BoxStatistics& statistics, const Window& window, double finest_edge) {
  const std::array<Census, BoxStatistics::kSizes>& sizes = statistics.sizes;
  std::array<Census, BoxStatistics::kSizes> finer;  // per size class: this class and all finer ones
  for (std::size_t i = 0; i < sizes.size(); ++i) {
    if (i > 0) finer[i] = finer[i - 1];
    finer[i].add(sizes[i]);
  }
  Census coarse;
  double coarse_side = 0.0, cost = 0.0;
  const auto close = [&](const Cells& cells) {
    append(plan, coarse, window, cells, coarse_side);
    cost += cells.cost;
    coarse = Census{};
  };
  for (std::size_t i = sizes.size(); i-- > 0;) {
    if (sizes[i].boxes == 0.0) continue;
    if (coarse.boxes > 0.0) {
      Census together = coarse;
      together.add(sizes[i]);
      const Cells alone = bestCellsOf(coarse, window), shared = bestCellsOf(together, window);
      const double asking = costOfAsking(finer[i], coarse, alone, window);
      const double apart = alone.cost + bestCellsOf(sizes[i], window).cost + asking;
      double joined = shared.cost;
      if (i > 0 && finer[i - 1].boxes > 0.0) joined += costOfAsking(finer[i - 1], together, shared, window);
      if (apart < joined) {
        cost += asking;
        close(alone);
      }
    }
    if (coarse.boxes == 0.0) coarse_side = finest_edge * std::pow(GridScale::kRatio, static_cast<double>(i));
    coarse.add(sizes[i]);
  }
  close(bestCellsOf(coarse, window));
  return cost;
}

/// Reverses the levels, so that the finest is the first, and numbers the cells of all levels.
void finish(CellPlan& plan) {
  const auto reverse = [&plan](auto& values) {
    std::reverse(values.begin(), values.begin() + static_cast<std::ptrdiff_t>(plan.levels));
  };
  reverse(plan.grids);
  reverse(plan.sides);
  reverse(plan.largest);
  reverse(plan.mean_sides);
  for (std::size_t level = 0; level < plan.levels; ++level) {
    const kernels::Grid& grid = plan.grids[level];
    plan.first_cells[level] = plan.cells;
    plan.cells += static_cast<std::uint32_t>(grid.slab) * (static_cast<std::uint32_t>(grid.last[grid.axes[2]]) + 1);
  }
}

}  // namespace

float longestSide(const Aabb& box) { return (box.max - box.min).maxCoeff(); }

CellPlan planFor(const std::vector<Aabb>& boxes, const ProxyId* ids, std::size_t count, double finest_edge, Rows rows) {
  const bool is_region = rows == Rows::of_region;
  CellPlan plan;
  plan.boxes = count;
  if (count == 0) return plan;
  const BoxStatistics statistics = statisticsOf(boxes, ids, count, finest_edge);
  const Vector &lower = statistics.lower, &upper = statistics.upper;
  std::optional<BoxSample> sample;
  if (!is_region || count >= kWorthSampling) sample.emplace(boxes, ids, count);
  Window window = sample ? windowOf(*sample, lower, upper) : Window{lower, upper};
  window.spare_cells = static_cast<double>(is_region ? CellPlan::kSpareCellsOfRegion : CellPlan::kSpareCells);
  Census all;
  for (const Census& level : statistics.sizes) all.add(level);
  window.axes = axesFor(window, all);
  for (std::size_t i = 0; i < 3; ++i) {
    plan.lower[i] = static_cast<float>(lower[i]);
    plan.upper[i] = static_cast<float>(upper[i]);
    plan.windowed = plan.windowed || window.low[i] > lower[i] || window.high[i] < upper[i];
  }
  const double cost = planLevels(plan, statistics, window, finest_edge);
  if (rows == Rows::any) {
    const Cells one_row = oneRowOf(all, *sample, window);
    if (one_row.cost < cost && (count <= kFewInOneRow || sample->isThin(one_row.axes[0], all.mean()))) {
      plan.levels = 0;
      plan.followers = one_row.followers;
      append(plan, all, window, one_row, *std::max_element(all.largest.begin(), all.largest.end()));
    }
  }
  finish(plan);
  return plan;
}

std::size_t CellPlan::mostCells(std::size_t count) {
  return static_cast<std::size_t>(kMostCellsPerBox) * count + kSpareCells * std::min(count, kMostLevels);
}

double rowsAsked(const kernels::Level& asking, const kernels::Level& asked) {
  const kernels::Grid& grid = asked.grid;
  double rows = 1.0;
  for (const std::int32_t i : {grid.axes[1], grid.axes[2]}) {
    const double across = (static_cast<double>(asking.mean_sides[i]) + asked.reach[i]) * grid.inverse[i];
    rows *= std::min(1.0 + across, static_cast<double>(grid.last[i]) + 1.0);
  }
  return rows;
}

}  // namespace hgrid
