// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

#include <array>
#include <vector>

#include "hgrid_proximity/geometry/shape.h"

namespace hgrid {
namespace bench {

/// The convex hull of a few points, as libraries want it that do not compute hulls themselves.
struct HullFaces {
  Eigen::Vector3d center;                 ///< [m] the mean of the corners, in the frame of the shape
  std::vector<Eigen::Vector3d> corners;   ///< [m] relative to the center
  std::vector<std::array<int, 3>> faces;  ///< counter-clockwise when seen from outside
};

/// Tries all triangles. So the points must be few, and no four of them may lie in one plane.
HullFaces hullFacesOf(const std::vector<Eigen::Vector3d>& points);

}  // namespace bench
}  // namespace hgrid
