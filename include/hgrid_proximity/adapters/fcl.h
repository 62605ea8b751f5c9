// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

#include <memory>

#include "hgrid_proximity/narrow/narrow_phase.h"

namespace hgrid {

/// Creates a narrow phase that measures like makeCoreNarrowPhase(). It also knows depth and normal of more contacts. It
/// needs FCL (flexible-collision-library 0.6 or 0.7).
///
/// If convex cores overlap, FCL proposes depth and normal. They are reported only if a check shows that moving the
/// shapes apart by them separates the shapes. Distances are not measured by FCL: its solvers for convex shapes stop
/// when the distance no longer shrinks, which can be centimeters too early.
std::shared_ptr<NarrowPhase> makeFclNarrowPhase();

}  // namespace hgrid
