// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

#include <memory>

#include "hgrid_proximity/narrow/narrow_phase.h"

namespace hgrid {

/// Creates the narrow phase for all shapes, meshes included. It needs FCL (flexible-collision-library 0.6 or 0.7).
///
/// - Convex shapes are measured in the same way as by makeConvexNarrowPhase(). FCL's own solvers for convex shapes stop
///   when the distance no longer shrinks. In ordinary poses this can be centimeters too early.
/// - FCL measures the distance of two meshes, and it provides the tree over the triangles of a mesh.
/// - If convex cores overlap, FCL proposes depth and normal. They are reported only if a check shows that moving the
///   shapes apart by them separates the shapes.
std::shared_ptr<NarrowPhase> makeFclNarrowPhase();

}  // namespace hgrid
