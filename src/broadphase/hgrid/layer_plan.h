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

/// What a sort has counted, as of the boxes now.
struct BoxCensus {
  const float *lower = nullptr, *upper = nullptr;  ///< [m] least and greatest minimum corner; of one region
  const float* sizes = nullptr;                    ///< [m] 4 floats per level: largest extents, unspecified
};

/// How a layer is divided into regions, each region into levels, and each level into cells.
///
/// The arrays hold the levels of all regions, region after region.
class LayerPlan {
 public:
  /// Allocates what one region needs.
  LayerPlan();

  /// Plans one region without levels.
  void clear();
  /// Plans one region. Allocates nothing.
  void planOneRegion(const std::vector<Aabb>& boxes, const ProxyId* ids, std::size_t count, double finest_edge);
  /// Plans regions, each with about evenly spread boxes.
  ///
  /// @param ids      are sorted by region
  /// @param scratch  at least `count` values
  /// @returns false if one region is best; then the plan is as it was
  /// @throws std::bad_alloc; then the plan is as it was, and `ids` may be in another order
  bool planRegions(const std::vector<Aabb>& boxes, ProxyId* ids, std::uint32_t* scratch, std::size_t count,
                   double finest_edge);

  bool isDivided() const { return tree_.size() > 1; }
  std::size_t levels() const { return grids_.size(); }
  std::uint32_t cells() const { return cells_; }  ///< of all levels
  const kernels::Grid* grids() const { return grids_.data(); }
  const float* sides() const { return sides_.data(); }  ///< [m] longest side of a level's boxes
  const std::uint32_t* firstCells() const { return first_cells_.data(); }
  const float* meanSides(std::size_t level) const { return mean_sides_[level].data(); }
  const RegionTree& tree() const { return tree_; }
  RegionTree& tree() { return tree_; }

  /// Whether it is still a good plan for this many boxes.
  bool fits(std::size_t count) const;
  /// Whether it is still a good plan for such boxes.
  bool fits(const BoxCensus& now) const;
  /// Whether the boxes are still about where they were.
  /// @param levels  with the boxes of the last sort
  bool fits(const std::vector<kernels::Level>& levels) const;
  std::size_t bytes() const;

 private:
  void append(const CellPlan& plan);

  std::vector<kernels::Grid> grids_;
  std::vector<float> sides_;
  std::vector<std::uint32_t> first_cells_;        // counted through all levels
  std::vector<std::array<float, 3>> largest_;     // [m] extents when the plan was made
  std::vector<std::array<float, 3>> mean_sides_;  // [m]
  std::vector<std::uint32_t> region_boxes_;       // per region, when the plan was made
  RegionTree tree_;
  std::uint32_t cells_ = 0;
  std::size_t boxes_ = 0;                   // that the plan was made for
  std::array<float, 3> lower_{}, upper_{};  // [m] of one region: least and greatest minimum corner then
  bool windowed_ = false;                   // of one region: some boxes lay outside the window of the cells
};

}  // namespace hgrid
