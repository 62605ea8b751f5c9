// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#include "broadphase/hgrid/cell_plan.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "broadphase/hgrid/cell_costs.h"
#include "broadphase/hgrid/shape_levels.h"
#include "geometry/rounding.h"

namespace hgrid {
namespace {

constexpr std::size_t kFewInOneRow = 2048;   // boxes; so few may share a row, even if queries must test all its leaves
constexpr std::size_t kWorthShapes = 4096;   // boxes; for fewer, planning levels by shape takes too long
constexpr double kClearlyLess = 0.85;        // levels by shape are used only if they cost less than this fraction
constexpr std::size_t kWorthSampling = 256;  // boxes; in a smaller region, the window contains all boxes

/// Computes the window. On each axis, it contains the middle 98 % of the minimum corners, and it extends beyond each
/// end by half of their length. It never extends beyond the outermost corner. So one box that is a million meters away
/// does not make the cells of the others a thousand times too large.
Window windowOf(const BoxSample& sample, const Census::Vector& lower, const Census::Vector& upper) {
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
  const auto length = [&](std::size_t axis) { return window.length(axis) / std::max(all.mean(axis), kLeastLength); };
  const std::size_t other = length(2) > length(1) ? 2 : 1;
  if (!(length(other) > kClearly * length(0))) return {0, 1, 2};
  return other == 1 ? std::array<std::size_t, 3>{1, 0, 2} : std::array<std::size_t, 3>{2, 0, 1};
}

/// Appends a level with these cells to the plan.
void append(CellPlan& plan, const Census& census, const Window& window, const Cells& cells, double side) {
  const std::size_t number = plan.levels++;
  kernels::Grid& grid = plan.grids[number];
  for (std::size_t i = 0; i < 3; ++i) {
    grid.inverse[i] = static_cast<float>(1.0 / std::clamp(cells.edge[i], kLeastLength, 1e30));
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

/// Plans the levels, the coarsest first, and returns the estimated cost [ns] to find all pairs.
///
/// Goes through the size classes from the coarsest to the finest. Each class either shares the level of the class
/// before, or has a level of its own. The boxes of a level of its own are tested against the coarser levels. The
/// cheaper way is taken.
double planLevels(CellPlan& plan, const BoxStatistics& statistics, const Window& window) {
  const std::array<Census, BoxStatistics::kSizes>& sizes = statistics.sizes;
  std::array<Census, BoxStatistics::kSizes> finer;  // per size class: this class and all finer ones
  for (std::size_t i = 0; i < sizes.size(); ++i) {
    if (i > 0) finer[i] = finer[i - 1];
    finer[i].add(sizes[i]);
  }
  Census coarse;  // the boxes of the current level
  Cells cells;    // the best cells for them
  double coarse_side = 0.0, cost = 0.0;
  const auto close = [&] {
    append(plan, coarse, window, cells, coarse_side);
    cost += cells.cost;
    coarse = Census{};
  };
  for (std::size_t i = sizes.size(); i-- > 0;) {
    if (sizes[i].boxes == 0.0) continue;
    const Cells own = bestCellsOf(sizes[i], window);
    bool share = coarse.boxes > 0.0;
    if (share) {
      Census together = coarse;
      together.add(sizes[i]);
      const Cells shared = bestCellsOf(together, window);
      const double asking = costOfAsking(finer[i], coarse, cells);
      const double apart = cells.cost + own.cost + asking;
      double joined = shared.cost;
      if (i > 0 && finer[i - 1].boxes > 0.0) joined += costOfAsking(finer[i - 1], together, shared);
      if (apart < joined) {
        cost += asking;
        close();
        share = false;
      } else {
        cells = shared;
      }
    }
    if (!share) {
      cells = own;
      coarse_side = statistics.finest_edge * std::pow(GridScale::kRatio, static_cast<double>(i));
    }
    coarse.add(sizes[i]);
  }
  close();
  return cost;
}

/// Replaces the levels of the plan by levels by shape.
void setLevels(CellPlan& plan, const ShapeLevels& levels, const Window& window) {
  plan.levels = 0;
  plan.by_shape = true;
  plan.level_of_shape = levels.of_shape;
  plan.rare_boxes = levels.censuses[levels.count - 1].boxes;
  for (std::size_t i = 0; i < levels.count; ++i) {
    const Census& census = levels.censuses[i];
    append(plan, census, window, levels.cells[i], *std::max_element(census.largest.begin(), census.largest.end()));
  }
}

/// Reverses the levels if their order is that of sizes, so that the finest is the first. Numbers the cells of all
/// levels.
void finish(CellPlan& plan) {
  const auto reverse = [&plan](auto& values) {
    std::reverse(values.begin(), values.begin() + static_cast<std::ptrdiff_t>(plan.levels));
  };
  if (!plan.by_shape) {
    reverse(plan.grids);
    reverse(plan.sides);
    reverse(plan.largest);
    reverse(plan.mean_sides);
  }
  for (std::size_t level = 0; level < plan.levels; ++level) {
    const kernels::Grid& grid = plan.grids[level];
    plan.first_cells[level] = plan.cells;
    plan.cells += static_cast<std::uint32_t>(grid.slab) * (static_cast<std::uint32_t>(grid.last[grid.axes[2]]) + 1);
  }
}

}  // namespace

CellPlanner::CellPlanner(const std::vector<Aabb>& boxes, const ProxyId* ids, std::size_t count, double finest_edge,
                         Layout layout)
    : layout_(layout),
      statistics_(
          statisticsOf(boxes, ids, count, finest_edge,
                       layout == Layout::one_region && count >= kWorthShapes ? Shapes::counted : Shapes::ignored)) {
  if (count == 0) return;
  if (layout == Layout::one_region || count >= kWorthSampling) sample_.emplace(boxes, ids, count);
  window_ =
      sample_ ? windowOf(*sample_, statistics_.lower, statistics_.upper) : Window{statistics_.lower, statistics_.upper};
  window_.spare_cells =
      static_cast<double>(layout == Layout::regions ? CellPlan::kSpareCellsOfRegion : CellPlan::kSpareCells);
  window_.axes = axesFor(window_, statistics_.all());
}

CellPlan CellPlanner::plan(Rows rows) const {
  CellPlan plan;
  plan.boxes = statistics_.boxes;
  if (plan.boxes == 0) return plan;
  for (std::size_t i = 0; i < 3; ++i) {
    plan.lower[i] = static_cast<float>(statistics_.lower[i]);
    plan.upper[i] = static_cast<float>(statistics_.upper[i]);
    plan.windowed = plan.windowed || window_.low[i] > statistics_.lower[i] || window_.high[i] < statistics_.upper[i];
  }
  double cost = planLevels(plan, statistics_, window_);
  if (layout_ == Layout::one_region && plan.boxes >= kWorthShapes) {
    const ShapeLevels levels = shapeLevelsOf(statistics_.shapes, window_);
    if (levels.cost < kClearlyLess * cost) {
      cost = levels.cost;
      setLevels(plan, levels, window_);
    }
  }
  if (layout_ == Layout::one_region && rows == Rows::any) {
    const Census all = statistics_.all();
    const Cells one_row = oneRowOf(all, *sample_, window_, cost);
    if (one_row.cost < cost && (plan.boxes <= kFewInOneRow || sample_->isThin(one_row.axes[0], all.mean()))) {
      plan.levels = 0;
      plan.by_shape = false;
      plan.followers = one_row.followers;
      append(plan, all, window_, one_row, *std::max_element(all.largest.begin(), all.largest.end()));
    }
  }
  finish(plan);
  return plan;
}

std::size_t CellPlan::mostCells(std::size_t count, std::size_t levels) {
  return static_cast<std::size_t>(kMostCellsPerBox) * count + kSpareCells * levels;
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
