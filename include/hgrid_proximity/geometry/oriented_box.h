// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

#include "hgrid_proximity/geometry/pose.h"

namespace hgrid {

/// A box at any position and orientation.
struct OrientedBox {
  Pose world_from_box = Pose::Identity();  ///< pose of the box center
  Eigen::Vector3d size;                    ///< [m] full side lengths, >= 0
};

/// Returns the length [m] of the shortest translation that separates two overlapping boxes, or 0 if they do not
/// overlap.
///
/// The shortest translation is either along a face normal of one box, or perpendicular to one edge of each box
/// (separating axis test; Ericson, Real-Time Collision Detection, 2005, section 4.4.1).
double penetrationDepth(const OrientedBox& first, const OrientedBox& second);

}  // namespace hgrid
