// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#include "broadphase/hgrid/cell_plan.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace hgrid {
namespace {

using Vector = std::array<double, 3>;

/// What is known of the boxes whose sizes fall on one level, or on several that are looked at as one.
struct Census {
  double boxes = 0.0;
  Vector largest{}, total{};

  void add(const Census& other) {
    boxes += other.boxes;
    for (std::size_t i = 0; i < 3; ++i) {
      largest[i] = std::max(largest[i], other.largest[i]);
      total[i] += other.total[i];
    }
  }
  double mean(std::size_t axis) const { return total[axis] / boxes; }
};

/// Where nearly all boxes begin.
struct Window {
  Vector low{}, high{};
  double length(std::size_t axis) const { return high[axis] - low[axis]; }
};

/// Cells for a level: edges, how many, and what finding its pairs would cost.
struct Cells {
  Vector edge{};
  std::array<double, 3> count{};
  double cost = std::numeric_limits<double>::infinity();
};

// Costs [ns], measured on one machine; only their ratios matter.
constexpr double kPerBox = 4.0, kPerRow = 3.0, kPerAskedRow = 6.0, kPerTest = 3.0, kPerCell = 0.15;
constexpr double kLanes = 8.0;  // boxes per test: one number for all instruction sets, since plans must not differ
constexpr double kMostCellsPerBox = 1.0, kFewestCells = 64.0;  // whole numbers: CellPlan::mostCells() counts on it

double cellsAlong(double length, double edge) { return std::floor(length / edge) + 1.0; }

/// Cost of all boxes of a level looking around in cells whose edge across the rows is `across`; along the rows cells
/// are short, since a range may begin and end anywhere.
Cells cellsOf(const Census& level, const Window& window, double across) {
  Cells cells;
  cells.edge[1] = cells.edge[2] = across;
  cells.count[1] = cellsAlong(window.length(1), across);
  cells.count[2] = cellsAlong(window.length(2), across);
  const double rows = cells.count[1] * cells.count[2];
  const double most = kMostCellsPerBox * level.boxes + kFewestCells;
  if (rows > most) return cells;  // too many
  // Where less than two cells per row are allowed, the edge is longer than the window: one cell.
  const double along = most / rows - 1.0;
  cells.edge[0] = std::max(across / 12.0, window.length(0) / (along < 1.0 ? 0.5 : along));
  if (!(cells.edge[0] > 0.0)) cells.edge[0] = 1.0;
  cells.count[0] = cellsAlong(window.length(0), cells.edge[0]);

  const auto chance = [&](std::size_t axis, double length) {
    return cells.count[axis] > 1.0 ? std::min(1.0, length / cells.edge[axis]) : 0.0;
  };
  const double up_y = chance(1, level.mean(1)), up_z = chance(2, level.mean(2)), down_y = chance(1, level.largest[1]);
  const double other_rows = up_y + up_z * (1.0 + up_y + down_y);
  const double per_metre = level.boxes / rows / std::max(window.length(0), cells.edge[0]);
  const double own = per_metre * (level.mean(0) + 0.5 * cells.edge[0]);
  const double other = per_metre * (level.mean(0) + level.largest[0] + cells.edge[0]);
  const auto tests = [](double candidates) { return kPerTest * (1.0 + candidates / kLanes); };
  const double per_box = kPerBox + kPerRow + tests(std::min(own, level.boxes)) +
                         other_rows * (kPerRow + tests(std::min(other, level.boxes)));
  cells.cost = level.boxes * per_box + kPerCell * cells.count[0] * rows;
  return cells;
}

Cells bestCellsOf(const Census& level, const Window& window) {
  const double widest = std::max({level.largest[1], level.largest[2], 1e-30});
  Cells best;
  for (const double factor : {1.0, 1.4, 2.0, 3.0, 4.0, 6.0, 10.0, 20.0, 50.0, 200.0, 1e3, 1e4}) {
    const Cells cells = cellsOf(level, window, factor * widest);
    if (cells.cost < best.cost) best = cells;
  }
  if (!std::isfinite(best.cost)) {  // so sparse that nothing fits: as many rows as are allowed, whatever their edge
    const double longest = std::max({window.length(1), window.length(2), 1e-30});
    best = cellsOf(level, window, 2.0 * longest / std::sqrt(kMostCellsPerBox * level.boxes + kFewestCells));
  }
  return best;
}

/// Cost of `asking` boxes looking up a coarser level that is not their own.
double costOfAsking(const Census& asking, const Census& asked, const Cells& cells) {
  double rows = 1.0;
  for (const std::size_t axis : {std::size_t{1}, std::size_t{2}}) {
    rows *= std::min(cells.count[axis], 1.0 + (asking.mean(axis) + asked.largest[axis]) / cells.edge[axis]);
  }
  const double along =
      std::min(1.0, (asking.mean(0) + asked.largest[0] + cells.edge[0]) / (cells.edge[0] * cells.count[0]));
  const double candidates = asked.boxes * along / (cells.count[1] * cells.count[2]);
  return asking.boxes * (kPerBox + rows * (kPerAskedRow + kPerTest * (1.0 + candidates / kLanes)));
}

/// From at most 1024 boxes: the middle 98 % of the minimum corners on each axis and half as much beyond, or all if
/// they reach no farther. One box lost at a million metres must not make the cells of the others a thousand times
/// too large.
Window windowOf(const std::vector<Aabb>& boxes, const ProxyId* ids, std::size_t count, const Vector& lower,
                const Vector& upper) {
  constexpr std::size_t kSample = 1024;
  const std::size_t stride = std::max<std::size_t>(1, count / kSample);
  Window window;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    std::array<float, kSample> values;
    std::size_t sampled = 0;
    for (std::size_t i = 0; i < count && sampled < kSample; i += stride) {
      values[sampled++] = boxes[ids[i]].min[static_cast<Eigen::Index>(axis)];
    }
    std::sort(values.begin(), values.begin() + static_cast<std::ptrdiff_t>(sampled));
    const double low = values[sampled / 100], high = values[sampled - 1 - sampled / 100];
    const double beyond = 0.5 * (high - low);
    window.low[axis] = std::max(lower[axis], low - beyond);
    window.high[axis] = std::min(upper[axis], high + beyond);
  }
  return window;
}

void append(CellPlan& plan, const Census& census, const Window& window, double side) {
  const Cells cells = bestCellsOf(census, window);
  const std::size_t number = plan.levels++;
  kernels::Grid& grid = plan.grids[number];
  for (std::size_t i = 0; i < 3; ++i) {
    grid.inverse[i] = static_cast<float>(1.0 / std::clamp(cells.edge[i], 1e-30, 1e30));
    grid.origin[i] = static_cast<float>(window.low[i] * static_cast<double>(grid.inverse[i]));
    grid.last[i] = static_cast<float>(cells.count[i] - 1.0);
    plan.largest[number][i] = static_cast<float>(census.largest[i]);
    plan.mean_sides[number][i] = static_cast<float>(census.mean(i));
  }
  grid.row = static_cast<std::int32_t>(cells.count[0]);
  grid.slab = grid.row * static_cast<std::int32_t>(cells.count[1]);
  plan.sides[number] = static_cast<float>(side);
}

}  // namespace

float longestSide(const Aabb& box) { return (box.max - box.min).maxCoeff(); }

CellPlan planFor(const std::vector<Aabb>& boxes, const ProxyId* ids, std::size_t count, double finest_edge) {
  std::array<Census, GridScale::kLevels + 1> sizes;
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  Vector lower, upper;
  lower.fill(kInfinity);
  upper.fill(-kInfinity);
  for (std::size_t k = 0; k < count; ++k) {
    const Aabb& box = boxes[ids[k]];
    double edge = finest_edge;
    std::size_t number = 0;
    for (const double side = longestSide(box); number < GridScale::kLevels && side > edge; ++number) {
      edge *= GridScale::kRatio;
    }
    Census& level = sizes[number];
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
  CellPlan plan;
  plan.boxes = count;
  if (count == 0) return plan;
  const Window window = windowOf(boxes, ids, count, lower, upper);
  for (std::size_t i = 0; i < 3; ++i) {
    plan.lower[i] = static_cast<float>(lower[i]);
    plan.upper[i] = static_cast<float>(upper[i]);
    plan.windowed = plan.windowed || window.low[i] > lower[i] || window.high[i] < upper[i];
  }

  // From the coarsest level down: does the next finer one stand with it, or alone and asks it?
  std::array<Census, GridScale::kLevels + 1> finer;  // all levels up to this one
  for (std::size_t i = 0; i < sizes.size(); ++i) {
    if (i > 0) finer[i] = finer[i - 1];
    finer[i].add(sizes[i]);
  }
  Census coarse;
  double coarse_side = 0.0;
  const auto close = [&] {
    append(plan, coarse, window, coarse_side);
    coarse = Census{};
  };
  for (std::size_t i = sizes.size(); i-- > 0;) {
    if (sizes[i].boxes == 0.0) continue;
    if (coarse.boxes > 0.0) {
      Census together = coarse;
      together.add(sizes[i]);
      const Cells alone = bestCellsOf(coarse, window), shared = bestCellsOf(together, window);
      double apart = alone.cost + bestCellsOf(sizes[i], window).cost + costOfAsking(finer[i], coarse, alone);
      double joined = shared.cost;
      if (i > 0 && finer[i - 1].boxes > 0.0) joined += costOfAsking(finer[i - 1], together, shared);
      if (apart < joined) close();
    }
    if (coarse.boxes == 0.0) coarse_side = finest_edge * std::pow(GridScale::kRatio, static_cast<double>(i));
    coarse.add(sizes[i]);
  }
  close();
  const auto finestFirst = [&plan](auto& values) {
    std::reverse(values.begin(), values.begin() + static_cast<std::ptrdiff_t>(plan.levels));
  };
  finestFirst(plan.grids);
  finestFirst(plan.sides);
  finestFirst(plan.largest);
  finestFirst(plan.mean_sides);
  for (std::size_t level = 0; level < plan.levels; ++level) {
    const kernels::Grid& grid = plan.grids[level];
    plan.first_cells[level] = plan.cells;
    plan.cells += static_cast<std::uint32_t>(grid.slab) * (static_cast<std::uint32_t>(grid.last[2]) + 1);
  }
  return plan;
}

std::size_t CellPlan::mostCells(std::size_t count) {
  const auto per_box = static_cast<std::size_t>(kMostCellsPerBox), per_level = static_cast<std::size_t>(kFewestCells);
  return per_box * count + per_level * std::min(count, kMostLevels);
}

bool CellPlan::fits(std::size_t count) const {
  const auto now = static_cast<double>(count), then = static_cast<double>(boxes);
  return now <= 1.25 * then + 8.0 && now >= 0.75 * then - 8.0;
}

bool CellPlan::fits(const float* lower_now, const float* upper_now, const float* largest_now) const {
  for (std::size_t level = 0; level < levels; ++level) {
    for (std::size_t i = 0; i < 3; ++i) {
      const float then = largest[level][i], now = largest_now[4 * level + i];
      if (now > 1.25f * then || now < 0.5f * then) return false;
    }
  }
  if (windowed) return true;  // its bounds are those of strays
  for (std::size_t i = 0; i < 3; ++i) {
    const double length = static_cast<double>(upper[i]) - lower[i], some = 0.1 * length + largest[levels - 1][i];
    const double now = static_cast<double>(upper_now[i]) - lower_now[i];
    if (lower_now[i] < lower[i] - some || upper_now[i] > upper[i] + some || now < 0.75 * length - some) return false;
  }
  return true;
}

double rowsAsked(const CellPlan& asking, std::size_t asking_level, const CellPlan& asked, std::size_t asked_level,
                 const float* reach_of_asked) {
  const kernels::Grid& grid = asked.grids[asked_level];
  double rows = 1.0;
  for (const std::size_t i : {std::size_t{1}, std::size_t{2}}) {
    const double across =
        (static_cast<double>(asking.mean_sides[asking_level][i]) + reach_of_asked[i]) * grid.inverse[i];
    rows *= std::min(1.0 + across, static_cast<double>(grid.last[i]) + 1.0);
  }
  return rows;
}

}  // namespace hgrid
