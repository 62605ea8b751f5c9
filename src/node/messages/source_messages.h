// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

#include <hgrid_proximity/SourceStatus.h>

#include <vector>

#include "node/params/params.h"
#include "node/tick/tick.h"

namespace hgrid {

namespace msg = ::hgrid_proximity;

/// The entry of every source in ~status, sorted by name: those that are configured and those that have bodies.
std::vector<msg::SourceStatus> sourcesOf(const Tick& tick, const Params& params);

}  // namespace hgrid
