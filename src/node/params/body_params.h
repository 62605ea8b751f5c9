// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

#include <string>
#include <vector>

#include "hgrid_proximity/bodies/body.h"
#include "hgrid_proximity/narrow/narrow_phase.h"
#include "node/params/params.h"

namespace hgrid {

/// Returns the last value whose pattern matches the name, or `otherwise` if no pattern matches.
double lastMatch(const std::vector<PatternValue>& values, const std::string& name, double otherwise);

/// Sets the guaranteed largest speed [m/s] of a body from the parameters that match its name.
void applySpeedBound(const Params& params, Body& body);

/// Sets the margin, the padding and the speed bound of a body from the parameters that match its name.
void applyPatterns(const Params& params, Body& body);

/// Sets the assumed maximum speed [m/s] of a body from the parameters. Use this if the model of the body does not limit
/// its speed.
void applyMaxSpeed(const Params& params, Body& body);

/// Sets the margin, the paddings and the speeds of an obstacle or a track.
/// @param margin     [m] 0: as the parameters say
/// @param max_speed  [m/s] 0: as the parameters say
/// @param obstacle   the paddings of its shapes stay if they are larger than what the parameters say
void applyObstacleParams(const Params& params, double margin, double max_speed, Body& obstacle);

/// Prepares the shapes of a body for exact distances. This may take long if meshes are large.
void makeSolids(NarrowPhase& narrow_phase, Body& body);

/// Calls applyObstacleParams() and makeSolids().
void completeObstacle(const Params& params, double margin, double max_speed, NarrowPhase& narrow_phase, Body& obstacle);

}  // namespace hgrid
