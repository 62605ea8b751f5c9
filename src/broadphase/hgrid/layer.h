// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

#include <cstdint>
#include <vector>

#include "broadphase/hgrid/layer_plan.h"
#include "broadphase/hgrid/level_bounds.h"
#include "broadphase/kernels/kernels.h"
#include "broadphase/workers.h"

namespace hgrid {

/// Buffers of sorting. All layers of a grid share them.
struct SortScratch {
  std::vector<Aabb> copies;           // boxes by position before the sort; used only for counts that exceed the cache
  std::vector<std::uint32_t> cells;   // by position before
  std::vector<std::uint32_t> counts;  // boxes per cell, for each thread but the last
  std::vector<std::uint32_t> sums;    // per thread and range of cells: boxes counted there
  std::vector<float> sizes;           // per thread and level, in fours
  std::vector<float> corners;         // per thread and level, in eights; only of layers with several regions
  std::vector<kernels::Keying> keyings;
};

/// The means of sorting.
struct Machine {
  const kernels::Kernels* kernels = nullptr;
  Workers* workers = nullptr;
  SortScratch* scratch = nullptr;
};

/// Boxes sorted by region, level and cell, as a structure of arrays, by two passes of counting (Ericson 2005, 7.1.4). A
/// layer is always sorted as a whole. Between two sorts, boxes can be withdrawn.
///
/// The caller calls reserve() before it changes anything, so a failed allocation leaves the layer as it was. Only
/// reserve() throws. Where sort() finds that several regions would be better than one, it allocates what they need; if
/// that fails, the layer has one region.
class Layer {
 public:
  /// Allocates what setIds() and sort() of `count` boxes need. The layer keeps its boxes and their order.
  /// @param ids  number of ids in use: the size of the array of boxes that sort() will get
  void reserve(std::size_t count, std::size_t ids, const Machine& machine);
  /// Sets which boxes the layer holds, in any order. Call reserve() before and sort() after it.
  void setIds(const std::vector<ProxyId>& ids);
  /// The same; the caller writes `count` ids to the returned array.
  ProxyId* setIds(std::size_t count);
  /// Sorts the boxes as they are now. Starts from the last order, because boxes move little. Allocates nothing after
  /// reserve() of as many boxes.
  /// @param boxes  by id
  void sort(const std::vector<Aabb>& boxes, double finest_edge, const Machine& machine);
  /// Removes the box at a position: from now on it overlaps nothing.
  void withdraw(std::uint32_t position);
  bool isWithdrawn(std::uint32_t position) const { return !(bounds_[position] <= bounds_[3 * stride_ + position]); }

  /// An array that the caller may use until the next sort(). reserve() keeps its values.
  std::vector<std::uint32_t>& spare() { return other_ids_; }

  std::size_t size() const { return count_; }  ///< positions, withdrawn ones included
  const ProxyId* ids() const { return ids_.data(); }
  /// The box at a position.
  Aabb boxAt(std::uint32_t position) const {
    const float* bound = bounds_.data() + position;
    return {{bound[0], bound[stride_], bound[2 * stride_]},
            {bound[3 * stride_], bound[4 * stride_], bound[5 * stride_]}};
  }
  /// Of all regions, region after region.
  const std::vector<kernels::Level>& levels() const { return levels_; }
  /// Whether there are several regions.
  bool isDivided() const { return plan_.isDivided(); }
  const RegionTree& regions() const { return plan_.tree(); }
  const LevelBounds& bounds() const { return level_bounds_; }
  kernels::LevelSet levelSet() const { return level_bounds_.over(levels_); }
  std::size_t bytes() const;
  /// @throws std::logic_error naming the promise that does not hold
  void checkInvariants(const std::vector<Aabb>& boxes) const;

 private:
  void makePlan(const std::vector<Aabb>& boxes, double finest_edge, const Machine& machine, std::size_t threads);
  bool divide(const std::vector<Aabb>& boxes, double finest_edge, const Machine& machine, std::size_t threads);
  void count(const std::vector<Aabb>& boxes, const Machine& machine, std::size_t threads);
  double crowding(const Machine& machine, std::size_t threads) const;
  void scatter(const std::vector<Aabb>& boxes, const Machine& machine, std::size_t threads);
  void describe(const SortScratch& scratch);
  void widen(std::size_t count);
  void point();
  std::uint32_t* countsOf(std::size_t thread, std::size_t threads, const Machine& machine);
  const std::uint32_t* countsOf(std::size_t thread, std::size_t threads, const Machine& machine) const;

  LayerPlan plan_;
  int sorts_with_plan_ = 0;
  std::size_t count_ = 0;
  std::vector<ProxyId> ids_, other_ids_;  // by position; the one is read while the other is written
  std::vector<float> bounds_;             // six arrays, stride_ apart: min x y z, max x y z by position
  std::size_t stride_ = 0;
  std::vector<std::uint32_t> start_;  // of each cell, and the end of the last
  std::vector<kernels::Level> levels_;
  LevelBounds level_bounds_;
};

}  // namespace hgrid
