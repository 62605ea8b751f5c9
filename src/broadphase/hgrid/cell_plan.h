// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "broadphase/kernels/kernels.h"
#include "hgrid_proximity/broadphase/hgrid.h"

namespace hgrid {

/// Largest of a box's three sides, as levels are chosen by it [m].
float longestSide(const Aabb& box);

/// How the boxes of a region are divided into levels, and each level into cells. Any plan gives right answers; a good
/// one gives them fast.
struct CellPlan {
  static constexpr std::size_t kMostLevels = GridScale::kLevels + 1;
  template <class Value>
  using PerLevel = std::array<Value, kMostLevels>;  // ascending by size; not a vector, so that a plan allocates nothing

  std::size_t levels = 0;
  PerLevel<kernels::Grid> grids{};
  PerLevel<float> sides{};                      ///< [m] longest side of its boxes; the last takes what is longer, too
  PerLevel<std::uint32_t> first_cells{};        ///< counted through all levels
  PerLevel<std::array<float, 3>> largest{};     ///< [m] extents when the plan was made
  PerLevel<std::array<float, 3>> mean_sides{};  ///< [m]

  std::uint32_t cells = 0;                ///< of all levels
  std::size_t boxes = 0;                  ///< that the plan was made for
  std::array<float, 3> lower{}, upper{};  ///< [m] least and greatest minimum corner then
  bool windowed = false;                  ///< some boxes lay outside the window of the cells

  /// A level may have so many cells more than boxes: the level of the one region, or of one of many.
  static constexpr std::size_t kSpareCells = 64, kSpareCellsOfRegion = 16;

  /// The most cells that a plan for `count` boxes has.
  static std::size_t mostCells(std::size_t count);
};

/// Divides the boxes of `count` ids as a model of the cost of finding all pairs says. Sizes that differ by less than a
/// factor of GridScale::kRatio share a level, as do levels so thinly populated that a look at both costs more than a
/// look at larger cells; among the edges of cells from once to many times the largest box the cheapest is taken.
/// @param even  the boxes are one of many regions, in which boxes are spread evenly
CellPlan planFor(const std::vector<Aabb>& boxes, const ProxyId* ids, std::size_t count, double finest_edge,
                 bool even = false);

/// Estimated rows of cells that a box of one level looks at in another.
double rowsAsked(const kernels::Level& asking, const kernels::Level& asked);

}  // namespace hgrid
