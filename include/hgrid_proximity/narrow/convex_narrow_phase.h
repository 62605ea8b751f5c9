// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

#include <memory>

#include "hgrid_proximity/narrow/narrow_phase.h"

namespace hgrid {

/// Makes the narrow phase of convex shapes. It needs no other library.
///
/// It measures spheres, boxes, cylinders, cones, capsules and hulls, and what questions are made of. solidOf() returns
/// null for a mesh.
///
/// - The distance comes with a proof (src/narrow/gjk.h): it is within 1e-10 m or what doubles give.
/// - A sphere is a point and a capsule is a segment, each with a radius around it; padding is added to that radius. So
///   round shapes are measured exactly.
/// - Two solids are measured in one order, in the frame of one of them. So the order of the question does not show in
///   the answer, and nothing is lost far from the origin.
/// - Depth, normal and points of a contact are known where the cores (what is within the radii) are apart or only
///   touch. Where the cores overlap, these values are NaN. makeFclNarrowPhase() knows more of them.
std::shared_ptr<NarrowPhase> makeConvexNarrowPhase();

}  // namespace hgrid
