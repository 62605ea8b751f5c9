// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

#include <hgrid_proximity/WorldState.h>

#include <string>

#include "node/messages/to_messages.h"
#include "node/params/params.h"

namespace hgrid {

/// What a tick says about the world as a whole.
/// @param age_since  [s] that passed since the tick was made
msg::WorldState worldState(const Tick& tick, const Params& params, std::uint64_t config_hash, double age_since);
/// Why candidate pairs may be missing from a snapshot's list, as a reason of an incomplete world. Empty if none are.
std::string truncationOf(const Snapshot& snapshot);

}  // namespace hgrid
