// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
//
// How a layer sorts its boxes: it plans the cells, counts the boxes of each cell, and moves each box to its position.
#include <algorithm>
#include <cmath>
#include <new>
#include <numeric>

#include "broadphase/hgrid/array_room.h"
#include "broadphase/hgrid/layer.h"
#include "geometry/infinity.h"

namespace hgrid {
namespace {

constexpr int kSortsPerPlan = 64;              // after so many sorts, the layer makes a new plan
constexpr int kSortsPerCheck = 8;              // after so many sorts, a layer with one row is checked
constexpr std::size_t kWorthRegions = 64;      // a layer with fewer boxes than this has one region
constexpr std::size_t kWorthOccupancy = 2048;  // for fewer boxes, the bits take too much memory per box
constexpr double kCrowded = 32.0;     // from this crowding() on, regions are tried; evenly spread boxes have about 2
constexpr double kLessCrowded = 0.6;  // regions are used if they reduce crowding() to less than this fraction

}  // namespace

void Layer::sort(const std::vector<Aabb>& boxes, double finest_edge, const Machine& machine) {
  withdrawn_ = 0;
  if (count_ == 0) {
    plan_.clear();
    levels_.clear();
    occupancy_.clear();
    return level_bounds_.setLevels(levels_);
  }
  if (isFew()) return putIntoOneCell(boxes);
  reserve(count_, boxes.size(), machine);
  SortScratch& scratch = *machine.scratch;
  const std::size_t threads = machine.threadsFor(count_);
  bool planned = !plan_.fits(count_) || ++sorts_with_plan_ > kSortsPerPlan || levels_.empty() || !plan_.fits(levels_);
  if (!planned) {
    count(boxes, machine, threads);
    const kernels::Keying& total = scratch.keyings.front();
    // A new plan is also needed if the boxes have changed too much.
    planned = !plan_.fits(BoxCensus{total.lower, total.upper, total.sizes}) ||
              (sorts_with_plan_ % kSortsPerCheck == 0 && isRowCrowded(machine, threads));
  }
  if (planned) {
    makePlan(boxes, finest_edge, machine, threads);
    sorts_with_plan_ = 0;
  }
  scatter(boxes, machine, threads);
  ids_.swap(other_ids_);
  describe(scratch);
}

/// Sorts a few boxes: they share one cell, and keep their order.
void Layer::putIntoOneCell(const std::vector<Aabb>& boxes) {
  if (!plan_.isOneCell()) plan_.planOneCell();
  start_[0] = 0;
  start_[1] = static_cast<std::uint32_t>(count_);
  levels_.resize(1);
  kernels::Level& level = levels_.front();
  level.grid = plan_.grids()[0];
  level.begin = 0;
  level.end = start_[1];
  // Four floats of a box are compared at once: its minimum corner and the number after it, or its maximum corner and
  // the number before it.
  using Four = Eigen::Array4f;
  Four lower = Four::Constant(kFloatInfinity), upper = -lower;
  float longest[3] = {0.0f, 0.0f, 0.0f}, sum[3] = {0.0f, 0.0f, 0.0f};  // of the sides
  for (std::size_t i = 0; i < count_; ++i) {
    const auto* const box = reinterpret_cast<const float*>(&boxes[ids_[i]]);
    lower = lower.min(Eigen::Map<const Four>(box));
    upper = upper.max(Eigen::Map<const Four>(box + 2));
    for (std::size_t k = 0; k < 6; ++k) bounds_[k * stride_ + i] = box[k];
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const float side = box[axis + 3] - box[axis];
      longest[axis] = std::max(longest[axis], side);
      sum[axis] += side;
    }
  }
  for (int axis = 0; axis < 3; ++axis) {
    level.reach[axis] = std::nextafter(longest[axis], kFloatInfinity);
    level.mean_sides[axis] = sum[axis] / static_cast<float>(count_);
    level.around.min[axis] = lower[axis];
    level.around.max[axis] = upper[axis + 1];
  }
  point();
  level_bounds_.setLevels(levels_);
  occupancy_.clear();
}

/// Makes a new plan and counts the boxes per cell. If too many boxes share a cell, and regions make the cells less
/// crowded, divides the layer into regions. If the layer is already divided, first tries to divide it again.
void Layer::makePlan(const std::vector<Aabb>& boxes, double finest_edge, const Machine& machine, std::size_t threads) {
  if (isDivided() && divide(boxes, finest_edge, machine, threads)) return count(boxes, machine, threads);
  const CellPlanner planner(boxes, ids_.data(), count_, finest_edge, Layout::one_region);
  planOneRegion(planner, Rows::any, machine);
  count(boxes, machine, threads);
  const Rows rows = isRowCrowded(machine, threads) ? Rows::several : Rows::any;
  if (rows == Rows::several) {
    planOneRegion(planner, rows, machine);
    count(boxes, machine, threads);
  }
  const double crowded = count_ >= kWorthRegions ? crowding(machine, threads) : 0.0;
  if (crowded < kCrowded) return;
  if (divide(boxes, finest_edge, machine, threads)) {
    count(boxes, machine, threads);
    if (crowding(machine, threads) < kLessCrowded * crowded) return;
  }
  planOneRegion(planner, rows, machine);
  count(boxes, machine, threads);
}

/// Plans one region. If it has more than the usual number of levels, allocates their memory; if that fails, plans one
/// cell.
void Layer::planOneRegion(const CellPlanner& planner, Rows rows, const Machine& machine) {
  const CellPlan plan = planner.plan(rows);
  try {
    reservePlan(count_, plan.levels, machine);
  } catch (const std::bad_alloc&) {
    return plan_.planOneCell();
  }
  plan_.planOneRegion(plan);
}

/// Plans several regions and allocates their memory. @returns false if one region is better or if memory ran out
bool Layer::divide(const std::vector<Aabb>& boxes, double finest_edge, const Machine& machine, std::size_t threads) {
  SortScratch& scratch = *machine.scratch;
  try {
    if (!plan_.planRegions(boxes, ids_.data(), scratch.cells.data(), count_, finest_edge)) return false;
    scratch.sizes.reserve(threads * 4 * plan_.levels());
    scratch.corners.reserve(threads * 8 * plan_.levels());
    growTo(scratch.counts, (threads - 1) * plan_.cells());
    levels_.reserve(plan_.levels());
    level_bounds_.reserveLevels(plan_.levels());
    if (count_ >= kWorthOccupancy) occupancy_.reserve();
    growTo(start_, plan_.cells() + std::size_t{1});
  } catch (const std::bad_alloc&) {
    return false;
  }
  return true;
}

/// Returns whether the boxes share one row and more of them follow a box than was planned. The followers of a box are
/// the later boxes of its cell, and the boxes of the next cells, as far as the mean side of a box reaches.
bool Layer::isRowCrowded(const Machine& machine, std::size_t threads) const {
  if (!plan_.isOneRow()) return false;
  const auto boxesIn = [&](std::size_t cell) {
    double boxes = 0.0;
    for (std::size_t thread = 0; thread < threads; ++thread) boxes += countsOf(thread, threads, machine)[cell];
    return boxes;
  };
  const kernels::Grid& grid = plan_.grids()[0];
  const std::size_t cells = plan_.cells();
  const auto reach =
      static_cast<std::size_t>(std::min(plan_.meanSides(0)[grid.axes[0]] * grid.inverse[grid.axes[0]], 1e6f) + 0.5f);
  double ahead = 0.0, followers = 0.0;  // boxes in the next `reach` cells
  for (std::size_t cell = 0; cell < std::min(reach, cells); ++cell) ahead += boxesIn(cell);
  for (std::size_t cell = 0; cell < cells; ++cell) {
    const double here = boxesIn(cell);
    if (cell + reach < cells) ahead += boxesIn(cell + reach);
    ahead -= here;
    followers += here * (0.5 * (here - 1.0) + ahead);
  }
  return !plan_.fitsFollowers(followers / static_cast<double>(count_));
}

/// Returns how crowded the cells are: the average over all boxes of the number of boxes in the cell of a box.
double Layer::crowding(const Machine& machine, std::size_t threads) const {
  double sum = 0.0;
  for (std::size_t cell = 0; cell < plan_.cells(); ++cell) {
    std::uint32_t boxes = 0;
    for (std::size_t thread = 0; thread < threads; ++thread) boxes += countsOf(thread, threads, machine)[cell];
    sum += static_cast<double>(boxes) * boxes;
  }
  return sum / static_cast<double>(count_);
}

/// Returns the counters of a thread, one for each cell. The counters of the last thread are in `start_`: the counter of
/// cell i is start_[i + 1]. After the second pass, this counter is the end of cell i and the start of cell i + 1.
std::uint32_t* Layer::countsOf(std::size_t thread, std::size_t threads, const Machine& machine) {
  return thread + 1 == threads ? start_.data() + 1 : machine.scratch->counts.data() + thread * plan_.cells();
}

const std::uint32_t* Layer::countsOf(std::size_t thread, std::size_t threads, const Machine& machine) const {
  return const_cast<Layer*>(this)->countsOf(thread, threads, machine);
}

void Layer::count(const std::vector<Aabb>& boxes, const Machine& machine, std::size_t threads) {
  SortScratch& scratch = *machine.scratch;
  const std::size_t cells = plan_.cells(), levels = plan_.levels();
  const bool divided = plan_.isDivided();
  scratch.sizes.assign(threads * 4 * levels, 0.0f);
  if (divided) scratch.corners.resize(threads * 8 * levels);
  scratch.keyings.resize(threads);
  scratch.sums.resize(threads * threads);
  start_[0] = 0;
  machine.workers->run(threads, [&](std::size_t thread, std::size_t) {
    std::uint32_t* counts = countsOf(thread, threads, machine);
    std::fill_n(counts, cells, 0u);
    kernels::Keying& keying = scratch.keyings[thread];
    keying.boxes = reinterpret_cast<const kernels::Box*>(boxes.data());
    keying.order = ids_.data();
    keying.begin = count_ * thread / threads;
    keying.end = count_ * (thread + 1) / threads;
    keying.readable = count_;
    keying.copies = boxes.size() < kWorthCopying ? nullptr : reinterpret_cast<kernels::Box*>(scratch.copies.data());
    keying.cells = scratch.cells.data();
    keying.counts = counts;
    keying.grids = plan_.grids();
    keying.sides = plan_.sides();
    keying.first_cells = plan_.firstCells();
    keying.levels = static_cast<int>(levels);
    keying.level_of_shape = plan_.levelOfShape();
    keying.sizes = scratch.sizes.data() + 4 * levels * thread;
    std::fill_n(keying.lower, 4, kFloatInfinity);
    std::fill_n(keying.upper, 4, -kFloatInfinity);
    if (divided) {
      keying.regions = plan_.tree().regions();
      keying.branches = plan_.tree().branches();
      keying.corners = scratch.corners.data() + 8 * levels * thread;
      for (std::size_t level = 0; level < levels; ++level) {
        std::fill_n(keying.corners + 8 * level, 4, kFloatInfinity);
        std::fill_n(keying.corners + 8 * level + 4, 4, -kFloatInfinity);
      }
      machine.kernels->keyRegions(&keying);
    } else {
      machine.kernels->key(&keying);
    }
    for (std::size_t range = 0; range + 1 < threads; ++range) {
      const std::uint32_t *begin = counts + cells * range / threads, *end = counts + cells * (range + 1) / threads;
      scratch.sums[thread * threads + range] = std::accumulate(begin, end, 0u);
    }
  });
  for (std::size_t thread = 1; thread < threads; ++thread) {
    kernels::Keying &total = scratch.keyings.front(), &part = scratch.keyings[thread];
    for (std::size_t i = 0; i < 4 * levels; ++i) total.sizes[i] = std::max(total.sizes[i], part.sizes[i]);
    for (std::size_t i = 0; i < 3; ++i) {
      total.lower[i] = std::min(total.lower[i], part.lower[i]);
      total.upper[i] = std::max(total.upper[i], part.upper[i]);
    }
    for (std::size_t i = 0; divided && i < 8 * levels; ++i) {
      total.corners[i] =
          i % 8 < 4 ? std::min(total.corners[i], part.corners[i]) : std::max(total.corners[i], part.corners[i]);
    }
  }
}

void Layer::scatter(const std::vector<Aabb>& boxes, const Machine& machine, std::size_t threads) {
  const SortScratch& scratch = *machine.scratch;
  // Each job turns the counts of one range of cells into positions.
  machine.workers->run(threads, [&](std::size_t range, std::size_t) {
    std::uint32_t sum = 0;
    for (std::size_t i = 0; i < threads * threads; ++i) sum += i % threads < range ? scratch.sums[i] : 0;
    std::uint32_t* last = countsOf(threads - 1, threads, machine);
    const std::size_t end = plan_.cells() * (range + 1) / threads;
    for (std::size_t cell = plan_.cells() * range / threads; cell < end; ++cell) {
      for (std::size_t thread = 0; thread + 1 < threads; ++thread) {
        std::uint32_t& entry = machine.scratch->counts[thread * plan_.cells() + cell];
        const std::uint32_t count = entry;
        entry = sum;
        sum += count;
      }
      const std::uint32_t count = last[cell];
      last[cell] = sum;
      sum += count;
    }
  });
  machine.workers->run(threads, [&](std::size_t thread, std::size_t) {
    std::uint32_t* next = countsOf(thread, threads, machine);
    float* const bounds = bounds_.data();
    const std::size_t stride = stride_;
    const std::uint32_t* cells = scratch.cells.data();
    const ProxyId* from = ids_.data();
    const Aabb* by_id = boxes.data();
    const Aabb* copies = boxes.size() < kWorthCopying ? nullptr : scratch.copies.data();
    ProxyId* to = other_ids_.data();
    const std::size_t end = scratch.keyings[thread].end;
    for (std::size_t i = scratch.keyings[thread].begin; i < end; ++i) {
      const std::uint32_t position = next[cells[i]]++;
      const Aabb& box = copies == nullptr ? by_id[from[i]] : copies[i];
      bounds[position] = box.min[0];
      bounds[stride + position] = box.min[1];
      bounds[2 * stride + position] = box.min[2];
      bounds[3 * stride + position] = box.max[0];
      bounds[4 * stride + position] = box.max[1];
      bounds[5 * stride + position] = box.max[2];
      to[position] = from[i];
    }
  });
}

void Layer::describe(const SortScratch& scratch) {
  const kernels::Keying& total = scratch.keyings.front();
  levels_.resize(plan_.levels());
  for (std::size_t i = 0; i < levels_.size(); ++i) {
    kernels::Level& level = levels_[i];
    level.grid = plan_.grids()[i];
    level.begin = start_[plan_.firstCells()[i]];
    level.end = i + 1 < levels_.size() ? start_[plan_.firstCells()[i + 1]] : start_[plan_.cells()];
    const float *lower = total.lower, *upper = total.upper;
    if (plan_.isDivided()) {
      lower = total.corners + 8 * i;
      upper = lower + 4;
    }
    for (std::size_t axis = 0; axis < 3; ++axis) {
      // The size of a box is a difference that may have been rounded down.
      level.reach[axis] = std::nextafter(total.sizes[4 * i + axis], kFloatInfinity);
      level.mean_sides[axis] = plan_.meanSides(i)[axis];
      level.around.min[axis] = level.begin < level.end ? lower[axis] : kFloatInfinity;
      level.around.max[axis] =
          level.begin < level.end ? std::nextafter(upper[axis] + level.reach[axis], kFloatInfinity) : -kFloatInfinity;
    }
  }
  point();
  level_bounds_.setLevels(levels_);
  if (isOneRow()) box_bounds_.setBoxes(levels_.front());
  if (plan_.isDivided() && occupancy_.isReserved()) {
    occupancy_.set(levels_);
  } else {
    occupancy_.clear();  // cells, or the bounds of boxes, lead a query past empty parts
  }
}

}  // namespace hgrid
