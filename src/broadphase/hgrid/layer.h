// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

#include <algorithm>
#include <cstdint>
#include <vector>

#include "broadphase/hgrid/bounds_tree.h"
#include "broadphase/hgrid/layer_plan.h"
#include "broadphase/hgrid/occupancy.h"
#include "broadphase/kernels/kernels.h"
#include "broadphase/workers.h"

namespace hgrid {

constexpr std::size_t kWorthAThread = 16384;  ///< least number of boxes per thread for which another one saves time
constexpr std::size_t kReadBeyond = 16;       ///< positions of a level that kernels may read beyond its last box

/// Buffers for sorting. All layers of a grid share them. "By position" means: in the order that the boxes have before
/// the sort.
struct SortScratch {
  std::vector<Aabb> copies;              // boxes by position; used only if the boxes do not fit into the cache
  std::vector<std::uint32_t> cells;      // by position: index of the box's new cell
  std::vector<std::uint32_t> counts;     // number of boxes per cell, for each thread but the last
  std::vector<std::uint32_t> sums;       // per thread and range of cells: number of boxes that the thread counted there
  std::vector<float> sizes;              // [m] per thread and level: 4 floats, see kernels::Keying
  std::vector<float> corners;            // [m] per thread and level: corners of the region's boxes, see kernels::Keying
  std::vector<kernels::Keying> keyings;  // per thread
};

/// What sorting needs: the inner loops for the instruction set, the threads and the buffers.
struct Machine {
  const kernels::Kernels* kernels = nullptr;
  Workers* workers = nullptr;
  SortScratch* scratch = nullptr;

  /// Returns how many threads sort a layer with this number of boxes.
  std::size_t threadsFor(std::size_t boxes) const {
    const auto most = static_cast<std::size_t>(workers->threads());
    return std::max<std::size_t>(1, std::min(most, boxes / kWorthAThread));
  }
};

/// A set of boxes that are sorted by region, level and cell, and stored as a structure of arrays. The "position" of a
/// box is its index in these arrays. A counting sort with two passes (Ericson 2005, 7.1.4) sorts all boxes at once. A
/// few boxes are not sorted, because they share one cell. Between two sorts, boxes can be withdrawn.
///
/// The caller calls reserve() before it changes anything, so a failed allocation leaves the layer unchanged. The other
/// functions that change the layer do not throw. If sort() finds that several regions are better than one, or that many
/// levels are, it allocates memory for them. If this allocation fails, the layer has one region, or one cell.
class Layer {
 public:
  /// Allocates the memory that setIds() and sort() need for `count` boxes. The layer keeps its boxes and their order.
  /// @param ids  size of the array of boxes that sort() will receive
  void reserve(std::size_t count, std::size_t ids, const Machine& machine);
  /// Sets which boxes the layer holds, in any order. Call reserve() before this function and sort() after it.
  void setIds(const std::vector<ProxyId>& ids);
  /// Sets the number of boxes that the layer holds. The caller then writes their ids to the returned array.
  ProxyId* setIds(std::size_t count);
  /// Sorts the boxes with their current coordinates. Starts from the order of the last sort, because boxes move little.
  /// After reserve() for at least as many boxes, allocates nothing except memory for additional regions and levels.
  /// @param boxes  all boxes of the grid, by id
  /// @param finest_edge  [m] longest box side of the smallest size class
  void sort(const std::vector<Aabb>& boxes, double finest_edge, const Machine& machine);
  /// Withdraws the box at a position: searches no longer find it. The position remains unused until
  /// putBack() or the next sort().
  void withdraw(std::uint32_t position);
  /// Stores a withdrawn box again at its position, with its current coordinates, if the position can hold them: if the
  /// box is in the same cell as before and within the bounds that the last sort computed. @returns whether it did
  bool putBack(std::uint32_t position, const Aabb& box);
  bool isWithdrawn(std::uint32_t position) const { return !(bounds_[position] <= bounds_[3 * stride_ + position]); }

  /// Returns an array that the caller may use until the next sort(). reserve() keeps its values.
  std::vector<std::uint32_t>& spare() { return other_ids_; }

  std::size_t size() const { return count_; }  ///< number of boxes, withdrawn boxes included
  /// Returns whether there is nothing to find: no box, or only withdrawn boxes.
  bool isEmpty() const { return withdrawn_ == count_; }
  /// Returns the id of the box at each position.
  const ProxyId* ids() const { return ids_.data(); }
  ProxyId idAt(std::uint32_t position) const { return ids_[position]; }
  /// Returns the box at a position.
  Aabb boxAt(std::uint32_t position) const {
    const float* bound = bounds_.data() + position;
    return {{bound[0], bound[stride_], bound[2 * stride_]},
            {bound[3 * stride_], bound[4 * stride_], bound[5 * stride_]}};
  }
  /// Returns the levels of all regions, region after region.
  const std::vector<kernels::Level>& levels() const { return levels_; }
  /// Returns whether there are several regions.
  bool isDivided() const { return plan_.isDivided(); }
  const RegionTree& regions() const { return plan_.tree(); }
  /// Returns whether the layer has one level with one row of cells.
  bool isOneRow() const { return plan_.isOneRow(); }
  /// Returns the bounds for queries: those of the boxes if isOneRow(), else those of the levels. The bounds of a few
  /// boxes are those of their level.
  const BoundsTree& bounds() const { return isOneRow() && !isFew() ? box_bounds_ : level_bounds_; }
  /// Says where the layer certainly has no boxes.
  const Occupancy& occupancy() const { return occupancy_; }
  /// Returns the levels with a hierarchy of their bounds.
  kernels::LevelSet levelSet() const { return level_bounds_.over(levels_); }
  /// Returns what a query searches: the levels with bounds().
  kernels::LevelSet querySet() const {
    kernels::LevelSet set = bounds().over(levels_);
    if (isFew()) set.per_leaf = BoundsTree::kPerLeaf;  // tests the boxes without looking for their cells
    return set;
  }
  /// Returns the allocated memory [bytes].
  std::size_t bytes() const;
  /// @throws std::logic_error that names the first violated invariant
  void checkInvariants(const std::vector<Aabb>& boxes) const;

 private:
  /// Up to so many boxes share one cell, because a plan would take longer than it saves.
  static constexpr std::size_t kFew = 16;
  /// A grid of fewer boxes mostly stays in the cache. Of more, the sort copies the boxes when it first reads them.
  static constexpr std::size_t kWorthCopying = std::size_t{1} << 18;

  bool isFew() const { return count_ <= kFew; }
  void reservePlan(std::size_t count, std::size_t levels, const Machine& machine);
  void widen(std::size_t count);
  void point();
  bool fits(std::uint32_t position, const Aabb& box) const;
  void checkBoxBounds() const;

  // Steps of sort() (layer_sort.cpp).
  void putIntoOneCell(const std::vector<Aabb>& boxes);
  void makePlan(const std::vector<Aabb>& boxes, double finest_edge, const Machine& machine, std::size_t threads);
  void planOneRegion(const CellPlanner& planner, Rows rows, const Machine& machine);
  bool divide(const std::vector<Aabb>& boxes, double finest_edge, const Machine& machine, std::size_t threads);
  bool isRowCrowded(const Machine& machine, std::size_t threads) const;
  double crowding(const Machine& machine, std::size_t threads) const;
  std::uint32_t* countsOf(std::size_t thread, std::size_t threads, const Machine& machine);
  const std::uint32_t* countsOf(std::size_t thread, std::size_t threads, const Machine& machine) const;
  void count(const std::vector<Aabb>& boxes, const Machine& machine, std::size_t threads);
  void scatter(const std::vector<Aabb>& boxes, const Machine& machine, std::size_t threads);
  void describe(const SortScratch& scratch);

  LayerPlan plan_;
  int sorts_with_plan_ = 0;
  std::size_t count_ = 0;
  std::size_t withdrawn_ = 0;             // number of withdrawn boxes
  std::vector<ProxyId> ids_, other_ids_;  // by position; a sort reads ids_, writes other_ids_ and swaps the two
  std::vector<float> bounds_;             // [m] six arrays, stride_ floats apart: min x y z, max x y z, by position
  std::size_t stride_ = 0;
  std::vector<std::uint32_t> start_;  // position of the first box of each cell; at last, the end of the last cell
  std::vector<kernels::Level> levels_;
  BoundsTree level_bounds_;
  BoundsTree box_bounds_;  // bounds of successive boxes; valid only if isOneRow() and not isFew()
  Occupancy occupancy_;
};

}  // namespace hgrid
