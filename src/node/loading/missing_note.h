// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

#include <string>

#include "node/sources/source_id.h"
#include "node/tick/tick_jobs.h"
#include "node/world/world.h"

namespace hgrid {

/// Lets the next tick report why a robot, map or cloud is not in the world, or why its newest data could not be used.
inline void noteMissing(TickJobs& jobs, const SourceId& source, const std::string& sentence) {
  jobs.add("missing " + source.name, [source, sentence](World& world) { world.setMissing(source, sentence); });
}

}  // namespace hgrid
