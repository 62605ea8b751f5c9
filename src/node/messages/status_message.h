// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

#include <hgrid_proximity/Status.h>

#include "node/health/ledger.h"
#include "node/messages/to_messages.h"
#include "node/params/params.h"
#include "node/threads/stopwatch.h"

namespace hgrid {

/// Returns the message of ~status for a tick. It says what is missing, late or refused, and how long the work took.
msg::Status statusMessage(const Tick& tick, const msg::WorldState& world, const Params& params, const Ledger& ledger,
                          const Stopwatch& stopwatch);

}  // namespace hgrid
