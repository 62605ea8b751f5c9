// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

#include <string>
#include <vector>

#include "node/tick/body_trouble.h"
#include "node/world/movers.h"

namespace hgrid {

/// Describes what is wrong with a body of a mover. Call this only if its pose is not FRESH or the mover has a conflict.
BodyTrouble troubleOf(const Body& body, const BodyPose& pose, const Mover& mover, const std::string& world_frame);

/// Sorts by state, worst first. Troubles with the same state keep their order.
void sortWorstFirst(std::vector<BodyTrouble>& troubles);

}  // namespace hgrid
