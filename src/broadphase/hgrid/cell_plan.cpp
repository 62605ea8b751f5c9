// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#include "broadphase/hgrid/cell_plan.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

#include "broadphase/hgrid/box_sample.h"
#include "broadphase/hgrid/cell_costs.h"
#include "broadphase/hgrid/shape_levels.h"
#include "geometry/infinity.h"

namespace hgrid {
namespace {

using Vector = Census::Vector;

constexpr std::size_t kFewInOneRow = 2048;   // boxes; so few may share a row, even if queries must test all its leaves
constexpr std::size_t kWorthShapes = 4096;   // boxes; for fewer, planning levels by shape takes too long
constexpr double kClearlyLess = 0.85;        // levels by shape are used only if they cost less than this fraction
constexpr std::size_t kWorthSampling = 256;  // boxes; in a smaller region, the window contains all boxes

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
  ShapeCensuses shapes;
  Vector lower, upper;  // [m] bounds of the minimum corners
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
    Vector sides;
    for (std::size_t i = 0; i < 3; ++i) {
      const double low = box.min[static_cast<Eigen::Index>(i)];
      sides[i] = box.max[static_cast<Eigen::Index>(i)] - low;
      lower[i] = std::min(lower[i], low);
      upper[i] = std::max(upper[i], low);
    }
    const Eigen::Vector3f size = box.max - box.min;
    statistics.sizes[number].add(sides);
    statistics.shapes[shapeOf({size[0], size[1], size[2]})].add(sides);
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
      const double asking = costOfAsking(finer[i], coarse, alone);
      const double apart = alone.cost + bestCellsOf(sizes[i], window).cost + asking;
      double joined = shared.cost;
      if (i > 0 && finer[i - 1].boxes > 0.0) joined += costOfAsking(finer[i - 1], together, shared);
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
  double cost = planLevels(plan, statistics, window, finest_edge);
  if (!is_region && count >= kWorthShapes) {
    const ShapeLevels levels = shapeLevelsOf(statistics.shapes, window);
    if (levels.cost < kClearlyLess * cost) {
      cost = levels.cost;
      setLevels(plan, levels, window);
    }
  }
  if (rows == Rows::any) {
    const Cells one_row = oneRowOf(all, *sample, window);
    if (one_row.cost < cost && (count <= kFewInOneRow || sample->isThin(one_row.axes[0], all.mean()))) {
      plan.levels = 0;
      plan.by_shape = false;
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
