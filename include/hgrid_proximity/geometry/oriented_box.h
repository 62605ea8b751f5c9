// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

#include "hgrid_proximity/geometry/pose.h"

namespace hgrid {

/// A box in any pose.
struct OrientedBox {
  Pose world_from_box = Pose::Identity();  ///< of its center
  Eigen::Vector3d size;                    ///< [m] full lengths, >= 0
};

/// [m] Length of the shortest move that separates two boxes that overlap; 0 if they do not.
///
/// The shortest move is along a face normal of one box or perpendicular to an edge of each (separating axis test;
/// Ericson 2005, section 4.4.1).
double penetrationDepth(const OrientedBox& first, const OrientedBox& second);

}  // namespace hgrid
