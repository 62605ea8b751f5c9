// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

#include "hgrid_proximity/bodies/body.h"

namespace hgrid {

/// [m] No point of a body's padded shapes is farther from its origin.
double reachOf(const Body& body);

/// [m] How much nearer or farther two bodies can have come at most when both went from one pose to another.
/// @param reach  of the second
double relativeMotion(const Pose& world_from_first, const Pose& world_from_second, const Pose& world_from_first_now,
                      const Pose& world_from_second_now, double reach);

}  // namespace hgrid
