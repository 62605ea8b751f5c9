// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

#include "hgrid_proximity/bodies/body.h"

namespace hgrid {

/// Returns an upper bound [m] of the distance from the origin of a body to the points of its padded shapes.
double reachOf(const Body& body);

/// Returns an upper bound [m] of how much the distance of two bodies changes, if each moves from its former pose to
/// its pose now. `world_from_first` and `world_from_second` are the former poses.
/// @param reach  [m] reachOf() of the second body
double relativeMotion(const Pose& world_from_first, const Pose& world_from_second, const Pose& world_from_first_now,
                      const Pose& world_from_second_now, double reach);

}  // namespace hgrid
