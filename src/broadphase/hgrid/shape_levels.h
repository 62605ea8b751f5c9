// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>

#include "broadphase/hgrid/cell_costs.h"
#include "broadphase/kernels/kernels.h"

namespace hgrid {

/// Statistics of the boxes of each shape, see kernels::kShapes.
using ShapeCensuses = std::array<Census, kernels::kShapes>;

/// Levels for boxes that are long on some axes and thin on others, such as plates and rods. The boxes of a
/// frequent shape have a level of their own; all rare shapes share the last level. So the cells of a level can be short
/// where its boxes are thin, and the rows of cells can lie along the axis that is best for them. A level whose cells
/// must fit all shapes has long cells on all axes, and a search tests many boxes in vain.
struct ShapeLevels {
  std::size_t count = 0;                                  ///< number of levels
  std::array<Census, kernels::kShapes> censuses{};        ///< per level: statistics of its boxes
  std::array<Cells, kernels::kShapes> cells{};            ///< per level
  std::array<std::uint8_t, kernels::kShapes> of_shape{};  ///< per shape: its level
  double cost = std::numeric_limits<double>::infinity();  ///< [ns] estimated cost to find all pairs
};

/// Returns the shape of a box: bit i is set if it is long on axis i.
/// @param sides  [m] at least 0; floats, so that the result is the same as in the kernels
std::size_t shapeOf(const std::array<float, 3>& sides);

/// Plans levels for these shapes. The level of the rare shapes exists even if there is no such box yet.
/// @returns levels with an infinite cost if more than 70 % of the boxes are long on all axes, or if the longest box of a
///          frequent shape is more than three times as long as the mean on an axis on which the shape is long
ShapeLevels shapeLevelsOf(const ShapeCensuses& shapes, const Window& window);

}  // namespace hgrid
