// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

#include "narrow/ordered_solid.h"

namespace hgrid {

/// Sets depth and normal of the contact of a mesh and another solid, in the frame of `a`. Neither may be a plane.
///
/// In any direction, the two solids are apart after a move that is as long as their extents overlap in this direction.
/// The function tries the axes of the boxes around both solids, the cross products of these axes, the axes of meshes,
/// and the direction between the boxes. It then turns the best direction in smaller and smaller steps. It tries at most
/// 72 directions.
void boundDepth(const Side& a, const Side& b, Contact& contact);

}  // namespace hgrid
