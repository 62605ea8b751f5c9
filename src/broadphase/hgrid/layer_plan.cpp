// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#include "broadphase/hgrid/layer_plan.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <utility>

namespace hgrid {
namespace {

/// Sorts the ids by region. Ids of the same region keep their order.
class SortByRegion {
 public:
  /// @param scratch  overwritten; at least as many values as there are ids
  SortByRegion(const RegionTree& tree, const std::vector<Aabb>& boxes, ProxyId* ids, std::uint32_t* scratch)
      : tree_(tree), boxes_(boxes), ids_(ids), scratch_(scratch) {}

  /// @returns for each region the index of its first id, and at last the number of ids
  std::vector<std::size_t> operator()(std::size_t count) {
    begin_.reserve(tree_.size() + 1);
    sort(0, 0, count);
    begin_.push_back(count);
    return std::move(begin_);
  }

 private:
  /// Sorts the ids begin .. end - 1, which are in the part of space of a branch. Regions are numbered from below to
  /// above.
  void sort(std::uint32_t number, std::size_t begin, std::size_t end) {
    const kernels::Branch& branch = tree_.branches()[number];
    if (branch.axis < 0) return begin_.push_back(begin);
    std::size_t middle = begin, above = 0;
    for (std::size_t i = begin; i < end; ++i) {
      // Store the id in both places and advance one of them; a branch here would be mispredicted.
      const ProxyId id = ids_[i];
      const bool is_below = boxes_[id].min[branch.axis] < branch.split;
      ids_[middle] = scratch_[above] = id;
      middle += is_below;
      above += !is_below;
    }
    std::copy_n(scratch_, above, ids_ + middle);
    sort(branch.below, begin, middle);
    sort(branch.above, middle, end);
  }

  const RegionTree& tree_;
  const std::vector<Aabb>& boxes_;
  ProxyId* ids_;
  std::uint32_t* scratch_;
  std::vector<std::size_t> begin_;
};

}  // namespace

void LayerPlan::reserve(std::size_t levels) {
  grids_.reserve(levels);
  sides_.reserve(levels);
  first_cells_.reserve(levels);
  largest_.reserve(levels);
  mean_sides_.reserve(levels);
  region_boxes_.reserve(1);
}

void LayerPlan::clear() {
  grids_.clear();
  sides_.clear();
  first_cells_.clear();
  largest_.clear();
  mean_sides_.clear();
  region_boxes_.clear();
  tree_.join();
  cells_ = 0;
  boxes_ = 0;
  by_shape_ = false;
}

void LayerPlan::append(const CellPlan& plan) {
  for (std::size_t level = 0; level < plan.levels; ++level) {
    grids_.push_back(plan.grids[level]);
    sides_.push_back(plan.sides[level]);
    first_cells_.push_back(cells_ + plan.first_cells[level]);
    largest_.push_back(plan.largest[level]);
    mean_sides_.push_back(plan.mean_sides[level]);
  }
  region_boxes_.push_back(static_cast<std::uint32_t>(plan.boxes));
  cells_ += plan.cells;
}

void LayerPlan::planOneRegion(const CellPlan& plan) {
  clear();
  append(plan);
  tree_.setLevels(0, 0, static_cast<std::uint32_t>(plan.levels));
  boxes_ = plan.boxes;
  lower_ = plan.lower;
  upper_ = plan.upper;
  windowed_ = plan.windowed;
  followers_ = plan.followers;
  by_shape_ = plan.by_shape;
  level_of_shape_ = plan.level_of_shape;
  rare_boxes_ = plan.rare_boxes;
}

void LayerPlan::planOneCell() {
  CellPlan plan;
  plan.levels = 1;
  plan.cells = 1;
  kernels::Grid& grid = plan.grids[0];
  std::fill_n(grid.inverse, 3, 1e-30f);  // any positive number, because `last` is 0
  grid.row = grid.slab = grid.rows = 1;
  std::fill_n(grid.steps, 3, 1);
  std::iota(grid.axes, grid.axes + 3, 0);
  clear();
  append(plan);
  tree_.setLevels(0, 0, 1);
}

bool LayerPlan::planRegions(const std::vector<Aabb>& boxes, ProxyId* ids, std::uint32_t* scratch, std::size_t count,
                            double finest_edge) {
  LayerPlan divided;
  divided.reserve(1);
  divided.tree_ = RegionTree::dividing(boxes, ids, count);
  if (!divided.isDivided()) return false;
  const std::vector<std::size_t> begin = SortByRegion(divided.tree_, boxes, ids, scratch)(count);
  for (std::size_t region = 0; region < divided.tree_.size(); ++region) {
    const auto first_level = static_cast<std::uint32_t>(divided.levels());
    const CellPlan plan =
        CellPlanner(boxes, ids + begin[region], begin[region + 1] - begin[region], finest_edge, Layout::regions)
            .plan(Rows::several);
    divided.append(plan);
    divided.tree_.setLevels(region, first_level, static_cast<std::uint32_t>(plan.levels));
  }
  divided.boxes_ = count;
  *this = std::move(divided);
  return true;
}

bool LayerPlan::fits(std::size_t count) const {
  const auto now = static_cast<double>(count), then = static_cast<double>(boxes_);
  return now <= 1.25 * then + 8.0 && now >= 0.75 * then - 8.0;
}

bool LayerPlan::fits(const BoxCensus& now) const {
  if (isDivided()) return true;
  // The last level of a plan by shape has the rare shapes. If one box turns, the longest sides of this level change,
  // but the plan is still good.
  for (std::size_t level = 0; level < (by_shape_ ? levels() - 1 : levels()); ++level) {
    for (std::size_t i = 0; i < 3; ++i) {
      const float then = largest_[level][i], size = now.sizes[4 * level + i];
      if (size > 1.25f * then || size < 0.5f * then) return false;
    }
  }
  if (windowed_) return true;  // lower_ and upper_ then depend on a few far boxes and say nothing about the others
  for (std::size_t i = 0; i < 3; ++i) {
    float side = 0.0f;
    for (const std::array<float, 3>& largest : largest_) side = std::max(side, largest[i]);
    const double length = static_cast<double>(upper_[i]) - lower_[i], some = 0.1 * length + side;
    const double length_now = static_cast<double>(now.upper[i]) - now.lower[i];
    if (now.lower[i] < lower_[i] - some || now.upper[i] > upper_[i] + some || length_now < 0.75 * length - some) {
      return false;
    }
  }
  return true;
}

bool LayerPlan::fits(const std::vector<kernels::Level>& levels) const {
  if (by_shape_) {
    const auto rare = static_cast<double>(levels.back().end - levels.back().begin);
    return rare <= 2.0 * rare_boxes_ + 0.02 * static_cast<double>(boxes_) + 64.0;
  }
  if (!isDivided()) return true;
  constexpr double kMostElsewhere = 0.25;  // largest fraction of boxes that may be in other places than planned
  double elsewhere = 0.0;
  for (std::size_t region = 0; region < tree_.size(); ++region) {
    const kernels::Region& r = tree_.region(region);
    double boxes = 0.0;
    for (std::uint32_t i = 0; i < r.levels; ++i) {
      const kernels::Level& level = levels[r.first_level + i];
      boxes += level.end - level.begin;
      for (std::size_t axis = 0; axis < 3; ++axis) {
        if (level.reach[axis] > 2.0f * largest_[r.first_level + i][axis]) {
          elsewhere += level.end - level.begin;
          break;
        }
      }
    }
    elsewhere += std::max(0.0, boxes - region_boxes_[region]);
  }
  return elsewhere <= kMostElsewhere * static_cast<double>(boxes_);
}

std::size_t LayerPlan::bytes() const {
  return grids_.capacity() * sizeof(kernels::Grid) + sides_.capacity() * sizeof(float) +
         (first_cells_.capacity() + region_boxes_.capacity()) * sizeof(std::uint32_t) +
         (largest_.capacity() + mean_sides_.capacity()) * sizeof(std::array<float, 3>) + tree_.bytes();
}

}  // namespace hgrid
