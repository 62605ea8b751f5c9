// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

#include <hgrid_proximity/SourceStatus.h>

#include <vector>

#include "node/params/params.h"
#include "node/tick/tick.h"

namespace hgrid {

namespace msg = ::hgrid_proximity;

/// Returns an entry of ~status for every source that is expected or has bodies, sorted by name.
std::vector<msg::SourceStatus> sourcesOf(const Tick& tick, const Params& params);

}  // namespace hgrid
