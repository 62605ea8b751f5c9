// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

#include <memory>

#include "hgrid_proximity/narrow/narrow_phase.h"

namespace hgrid {

/// Makes the narrow phase of all shapes, meshes included. It needs FCL (flexible-collision-library 0.6 or 0.7).
///
/// - Convex shapes are measured as makeConvexNarrowPhase() measures them. FCL's own solvers for them end when the
///   distance stops shrinking, which in ordinary poses is up to centimeters too early.
/// - FCL measures two meshes, and provides the trees over the triangles of a mesh.
/// - FCL proposes depth and normal where convex cores overlap. They are reported only if moving the shapes apart by
///   them was verified to separate the shapes.
std::shared_ptr<NarrowPhase> makeFclNarrowPhase();

}  // namespace hgrid
