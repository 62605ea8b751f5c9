// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

#include <string>
#include <vector>

#include "hgrid_proximity/bodies/body.h"
#include "hgrid_proximity/narrow/narrow_phase.h"
#include "node/params/params.h"

namespace hgrid {

/// The last value whose pattern matches the name, or `otherwise`.
double lastMatch(const std::vector<PatternValue>& values, const std::string& name, double otherwise);

/// Sets the margin, the padding and the speed bound of a body to what the parameters say for its name.
void applyPatterns(const Params& params, Body& body);

/// Sets the speed [m/s] that a body is assumed not to exceed, for a body whose model bounds no speed.
void applyMaxSpeed(const Params& params, Body& body);

/// Prepares the shapes of a body for exact distances. This may take long for large meshes.
void makeSolids(NarrowPhase& narrow_phase, Body& body);

}  // namespace hgrid
