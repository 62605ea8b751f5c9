// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

#include <memory>

#include "hgrid_proximity/narrow/narrow_phase.h"

namespace hgrid {

/// Creates the narrow phase for all shapes, meshes included. It needs no other library.
///
/// - The distance of convex shapes is accurate to 1e-10 m, or to the precision of doubles if that is coarser. The
///   solver proves this with a lower and an upper bound (src/narrow/gjk.h).
/// - The distance to a mesh is that to its nearest triangle. A tree of boxes finds the triangle
///   (src/narrow/mesh_tree.h).
/// - Each shape is a core with a radius around it. The core of a sphere is a point, the core of a capsule is a segment.
///   Padding is added to the radius, so round shapes are measured exactly.
/// - Two solids are always measured in the same order, in the frame of one of them. So the result does not depend on
///   the order of the arguments, and no precision is lost far from the origin.
/// - The distance from a plane is that of the deepest point of the other shape. Depth and normal are always known.
/// - Otherwise, measure() knows depth, normal and points of a contact if the cores are apart. If they overlap, these
/// values
///   are NaN.
/// - measureContact() proves the depth of convex solids with two bounds (src/narrow/overlap.h). For meshes it compares
/// how
///   far both solids extend in a few dozen directions.
std::shared_ptr<NarrowPhase> makeCoreNarrowPhase();

}  // namespace hgrid
