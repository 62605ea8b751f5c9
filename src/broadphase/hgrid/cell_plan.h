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

/// Returns the longest of the three sides of a box [m]. It selects the level of the box.
float longestSide(const Aabb& box);

/// Says how the boxes of a region are divided into levels, and each level into cells. With every plan, searches give
/// the right answers. With a good plan, they are fast.
struct CellPlan {
  static constexpr std::size_t kMostLevels = GridScale::kLevels + 1;
  template <class Value>
  using PerLevel = std::array<Value, kMostLevels>;  // smallest boxes first; an array, because a plan must not allocate

  std::size_t levels = 0;  ///< number of levels
  PerLevel<kernels::Grid> grids{};
  PerLevel<float> sides{};                      ///< [m] longest box side; the last level also holds longer boxes
  PerLevel<std::uint32_t> first_cells{};        ///< number of the level's first cell, counted through all levels
  PerLevel<std::array<float, 3>> largest{};     ///< [m] longest box side per axis, when the plan was made
  PerLevel<std::array<float, 3>> mean_sides{};  ///< [m] mean box side per axis, when the plan was made

  std::uint32_t cells = 0;                ///< number of cells of all levels
  std::size_t boxes = 0;                  ///< number of boxes that the plan was made for
  std::array<float, 3> lower{}, upper{};  ///< [m] least and greatest minimum corner of these boxes
  bool windowed = false;                  ///< some boxes were outside the window, the space that is divided into cells

  /// A level has at most this many cells more than boxes. The second limit is for a layer with several regions.
  static constexpr std::size_t kSpareCells = 64, kSpareCellsOfRegion = 16;

  /// Returns the largest number of cells that a plan for `count` boxes can have.
  static std::size_t mostCells(std::size_t count);
};

/// Plans levels and cells for the boxes of `count` ids. A cost model estimates the time of a search for all pairs, and
/// the function selects what is cheapest:
///
/// - Boxes belong to one size class if their longest sides differ by less than a factor of GridScale::kRatio. Each
///   class has its own level, or shares one with other classes if two levels with few boxes cost more.
/// - The edge of the cells is one of several multiples of the longest box side, from 1 to 10000.
///
/// @param finest_edge  [m] longest box side of the smallest size class
/// @param even  true for one region of several: the boxes are spread evenly, so the window contains all of them
CellPlan planFor(const std::vector<Aabb>& boxes, const ProxyId* ids, std::size_t count, double finest_edge,
                 bool even = false);

/// Estimates how many rows of cells of the level `asked` a search visits for one box of the level `asking`.
double rowsAsked(const kernels::Level& asking, const kernels::Level& asked);

}  // namespace hgrid
