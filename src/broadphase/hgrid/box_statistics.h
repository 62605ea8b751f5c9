// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "broadphase/hgrid/cell_costs.h"
#include "broadphase/hgrid/shape_levels.h"
#include "hgrid_proximity/broadphase/hgrid.h"

namespace hgrid {

/// The sizes, the shapes and the bounds of some boxes. A plan of cells is made from them.
struct BoxStatistics {
  static constexpr std::size_t kSizes = GridScale::kLevels + 1;

  std::size_t boxes = 0;             ///< number of boxes
  std::array<Census, kSizes> sizes;  ///< per size class, smallest boxes first
  ShapeCensuses shapes;              ///< empty if they were not counted
  Census::Vector lower{}, upper{};   ///< [m] bounds of the minimum corners
  double finest_edge = 0.0;          ///< [m] longest box side of the smallest size class

  /// Returns the statistics of all boxes together.
  Census all() const;
};

/// Whether statisticsOf() fills BoxStatistics::shapes.
enum class Shapes : std::uint8_t { ignored, counted };

/// Computes the statistics of the boxes of `count` ids. Allocates nothing.
BoxStatistics statisticsOf(const std::vector<Aabb>& boxes, const ProxyId* ids, std::size_t count, double finest_edge,
                           Shapes shapes);

}  // namespace hgrid
