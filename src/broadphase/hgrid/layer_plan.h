// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "broadphase/hgrid/cell_plan.h"
#include "broadphase/hgrid/region_tree.h"

namespace hgrid {

/// Statistics of the current boxes. The first pass of a sort computes them.
struct BoxCensus {
  const float *lower = nullptr, *upper = nullptr;  ///< [m] bounds of the minimum corners; valid if there is one region
  const float* sizes = nullptr;  ///< [m] 4 values per level: longest sides along x, y, z; the 4th is undefined
};

/// Says how a layer is divided into regions, each region into levels, and each level into cells.
///
/// The arrays hold the levels of all regions, region after region.
class LayerPlan {
 public:
  /// Allocates the memory for one region with this number of levels.
  void reserve(std::size_t levels);

  /// Resets the plan to one region without levels.
  void clear();
  /// Sets a plan of one region. Allocates nothing after reserve() for at least as many levels.
  void planOneRegion(const CellPlan& plan);
  /// Plans one cell, for a few boxes, or because there is no memory for a better plan. fits() says that it is not good
  /// for more than 8 boxes. Allocates nothing after reserve().
  void planOneCell();
  /// Plans several regions for the boxes of `count` ids. In each region, boxes are spread about evenly.
  ///
  /// @param ids      in and out: the function sorts them by region
  /// @param scratch  at least `count` values, which the function overwrites
  /// @returns false if one region is best; then the plan is unchanged
  /// @throws std::bad_alloc; then the plan is unchanged, but the order of `ids` may have changed
  bool planRegions(const std::vector<Aabb>& boxes, ProxyId* ids, std::uint32_t* scratch, std::size_t count,
                   double finest_edge);

  /// Returns whether there are several regions.
  bool isDivided() const { return tree_.size() > 1; }
  std::size_t levels() const { return grids_.size(); }
  std::uint32_t cells() const { return cells_; }  ///< number of cells of all levels
  const kernels::Grid* grids() const { return grids_.data(); }
  const float* sides() const { return sides_.data(); }  ///< [m] longest box side of each level
  /// Returns the level of each shape, see CellPlan::by_shape; null if the longest side of a box selects its level.
  const std::uint8_t* levelOfShape() const { return by_shape_ ? level_of_shape_.data() : nullptr; }
  /// Returns whether all boxes share one cell.
  bool isOneCell() const { return cells_ == 1; }
  /// Returns whether all boxes share one level with one row of cells.
  bool isOneRow() const { return !isDivided() && levels() == 1 && grids_.front().rows == 1; }
  /// Returns whether this number of boxes that follow a box in the row is about what was planned, see
  /// CellPlan::followers. If it is larger, the row is slow.
  bool fitsFollowers(double followers) const { return followers <= 2.0 * followers_ + 8.0; }
  /// Returns for each level the index of its first cell among the cells of all levels.
  const std::uint32_t* firstCells() const { return first_cells_.data(); }
  /// Returns the mean box sides [m] of a level, per axis.
  const float* meanSides(std::size_t level) const { return mean_sides_[level].data(); }
  const RegionTree& tree() const { return tree_; }
  RegionTree& tree() { return tree_; }

  /// Returns whether the plan is still good for this number of boxes.
  bool fits(std::size_t count) const;
  /// Returns whether the plan is still good for boxes with these statistics.
  bool fits(const BoxCensus& now) const;
  /// Returns whether the boxes are still distributed over the regions about as when the plan was made.
  /// @param levels  the levels after the last sort
  bool fits(const std::vector<kernels::Level>& levels) const;
  /// Returns the allocated memory [bytes].
  std::size_t bytes() const;

 private:
  void append(const CellPlan& plan);

  std::vector<kernels::Grid> grids_;
  std::vector<float> sides_;
  std::vector<std::uint32_t> first_cells_;        // per level: index of its first cell among the cells of all levels
  std::vector<std::array<float, 3>> largest_;     // [m] per level and axis: longest box side when the plan was made
  std::vector<std::array<float, 3>> mean_sides_;  // [m] per level and axis: mean box side when the plan was made
  std::vector<std::uint32_t> region_boxes_;       // number of boxes per region when the plan was made
  RegionTree tree_;
  std::uint32_t cells_ = 0;
  std::size_t boxes_ = 0;                                        // number of boxes that the plan was made for, or 0
  bool by_shape_ = false;                                        // see CellPlan; false if there are several regions
  std::array<std::uint8_t, kernels::kShapes> level_of_shape_{};  // valid only if by_shape_
  double rare_boxes_ = 0.0;                                      // valid only if by_shape_
  // The next four members describe the boxes of the plan. They are valid only if the layer has one region and boxes_ is
  // not 0.
  std::array<float, 3> lower_{}, upper_{};  // [m] bounds of the minimum corners
  double followers_ = 0.0;                  // see CellPlan
  bool windowed_ = false;                   // whether some minimum corners were outside the window (see CellPlan)
};

}  // namespace hgrid
