// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

#include <cstdint>

#include "queries/states/tilted_box.h"

namespace hgrid {

/// Equal spheres that together contain a shape. Their centers form a lattice in the box around the shape, along its two
/// longest axes and symmetric to its center.
struct SphereCover {
  std::uint32_t axis[2] = {0, 1};   ///< axes of the box along which the centers are
  std::uint32_t count[2] = {1, 1};  ///< number of centers along each of them
  float step[2] = {0.0f, 0.0f};     ///< [m] distance between centers along each of them
  float radius = 0.0f;              ///< [m] radius of each sphere
  float whole = 0.0f;  ///< [m] radius of the one sphere around the center of the box that contains the shape
};

/// Returns spheres that contain a padded shape. @param box  the box around it
SphereCover coverOf(const TiltedBox<float>& box);

}  // namespace hgrid
