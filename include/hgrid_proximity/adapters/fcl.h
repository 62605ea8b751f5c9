// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

#include <memory>

#include "hgrid_proximity/narrow/narrow_phase.h"

namespace hgrid {

/// The narrow phase that FCL (flexible-collision-library 0.6 or 0.7) does part of the work of: two meshes, the trees
/// over the triangles of one, and depth and normal of contacts, which count only where moving the shapes apart by them
/// was tried.
///
/// The distance of convex shapes, and of triangles to them, is our own (src/narrow/gjk.h) and ends with a proof:
/// FCL's solvers end when the distance shrinks no more, which in ordinary poses is up to centimetres too early. A ball
/// is a point, a capsule a segment, each with a radius around it, and so is padding: what is round is measured exactly,
/// into contact too. Every pair is asked in one order, in the frame of one of the two, so that the order of the
/// question does not matter and nothing is lost far from the origin.
std::shared_ptr<NarrowPhase> makeFclNarrowPhase();

}  // namespace hgrid
