// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

#include <string>

#include "node/tick/tick_jobs.h"
#include "node/tick/world.h"

namespace hgrid {

/// Has the next tick say why a robot, map or cloud is not in the world, or not as its newest data has it.
/// @param name  of the robot, or map/name, cloud/name
inline void noteMissing(TickJobs& jobs, const std::string& name, const std::string& sentence) {
  jobs.add([name, sentence](World& world) { world.setMissing(name, sentence); });
}

}  // namespace hgrid
