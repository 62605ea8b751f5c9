// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <optional>
#include <vector>

#include "broadphase/hgrid/box_sample.h"
#include "broadphase/hgrid/box_statistics.h"
#include "broadphase/hgrid/cell_costs.h"
#include "broadphase/kernels/kernels.h"
#include "hgrid_proximity/broadphase/hgrid.h"

namespace hgrid {

/// Says how the boxes of a region are divided into levels, and each level into cells. Searches give the right answers
/// with every plan. They are fast with a good plan.
struct CellPlan {
  static constexpr std::size_t kMostLevels = GridScale::kLevels + 1;
  /// Values per level, smallest boxes first unless by_shape. An array, because a plan must not allocate.
  template <class Value>
  using PerLevel = std::array<Value, kMostLevels>;

  std::size_t levels = 0;  ///< number of levels
  PerLevel<kernels::Grid> grids{};
  PerLevel<float> sides{};  ///< [m] longest box side; the last level also holds longer boxes
  /// Whether the shape of a box selects its level; otherwise, its longest side does. If it does, the last level has the
  /// rare shapes.
  bool by_shape = false;
  std::array<std::uint8_t, kernels::kShapes> level_of_shape{};  ///< valid only if by_shape
  double rare_boxes = 0.0;                      ///< number of boxes on the last level; valid only if by_shape
  PerLevel<std::uint32_t> first_cells{};        ///< index of the level's first cell among the cells of all levels
  PerLevel<std::array<float, 3>> largest{};     ///< [m] longest box side per axis, when the plan was made
  PerLevel<std::array<float, 3>> mean_sides{};  ///< [m] mean box side per axis, when the plan was made

  std::uint32_t cells = 0;  ///< number of cells of all levels
  /// Estimated number of boxes that follow a box, if all boxes share one row because this number is small. Otherwise
  /// infinite.
  double followers = std::numeric_limits<double>::infinity();
  std::size_t boxes = 0;                  ///< number of boxes that the plan was made for
  std::array<float, 3> lower{}, upper{};  ///< [m] bounds of the minimum corners of these boxes
  /// Whether some minimum corners were outside the window. The window is the part of space that is divided into cells.
  bool windowed = false;

  /// Largest number of cells that a level can have beyond its number of boxes. kSpareCellsOfRegion is the limit for a
  /// layer with several regions.
  static constexpr std::size_t kSpareCells = 64, kSpareCellsOfRegion = 16;

  /// Returns the largest number of cells that a plan with `levels` levels for `count` boxes can have.
  static std::size_t mostCells(std::size_t count, std::size_t levels);
};

/// Says which rows of cells a plan may have.
enum class Rows : std::uint8_t {
  any,
  several,  ///< the boxes do not share one row because few of them follow a box: it was found that many do
};

/// Says whether a layer has one region or several. If it has several, the boxes of a plan are those of one of them.
/// They never share one row, fewer spare cells are allowed, and if the boxes are few, the window contains all their
/// minimum corners.
enum class Layout : std::uint8_t { one_region, regions };

/// Plans levels and cells for some boxes. A cost model estimates the time of a search for all pairs, and the planner
/// selects the cheapest plan:
///
/// - Boxes are divided into size classes by their longest side. From one class to the next, the largest possible side
///   grows by the factor GridScale::kRatio. Each class has its own level, or shares a level with other classes if that
///   costs less.
/// - Across the rows, the edge of a cell is one of several multiples, from 1/4 to 10000, of the longest box side on
///   these two axes. If all of them give too many cells, the number of cells determines the edge. Along the rows, cells
///   are shorter.
/// - If many boxes are thin, boxes of the same frequent shape share a level instead, whatever their size (ShapeLevels).
///   This is only considered for at least 4096 boxes in a layer with one region, and used if it clearly costs less.
/// - All boxes share one level, and its cells are one row along an axis, if each box overlaps only few others along
///   this axis. The boxes must be few, or boxes that are near each other along this axis must also be near each other
///   along the other axes, because queries depend on that.
class CellPlanner {
 public:
  /// Collects the statistics of the boxes of `count` ids. Allocates nothing.
  /// @param finest_edge  [m] longest box side of the smallest size class
  CellPlanner(const std::vector<Aabb>& boxes, const ProxyId* ids, std::size_t count, double finest_edge, Layout layout);
  /// Makes a plan. Allocates nothing.
  CellPlan plan(Rows rows) const;

 private:
  Layout layout_;
  BoxStatistics statistics_;
  std::optional<BoxSample> sample_;  // none for a region with few boxes
  Window window_;
};

/// Estimates how many rows of cells of the level `asked` a search visits for one box of the level `asking`.
double rowsAsked(const kernels::Level& asking, const kernels::Level& asked);

}  // namespace hgrid
