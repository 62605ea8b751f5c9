// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

#include <optional>

#include "hgrid_proximity/geometry/shape.h"

namespace hgrid {

/// How deep a point is inside a shape.
struct InnerDepth {
  double depth;             ///< [m] distance from the surface, >= 0
  Eigen::Vector3d outward;  ///< unit vector to the nearest point of the surface
};

/// Returns how deep a point is inside a sphere, box, cylinder, cone or capsule; nullopt for other shapes. If the point
/// is outside because of rounding, the depth is 0.
/// @param point  [m] in the frame of the shape
std::optional<InnerDepth> depthInside(const Shape& shape, const Eigen::Vector3d& point);

}  // namespace hgrid
