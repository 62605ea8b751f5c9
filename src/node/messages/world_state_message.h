// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

#include <hgrid_proximity/WorldState.h>

#include <string>

#include "node/messages/to_messages.h"
#include "node/params/params.h"

namespace hgrid {

/// Returns how current and how complete the data of a tick is.
/// @param age_since  [s] time since the tick was computed
msg::WorldState worldState(const Tick& tick, double age_since);
/// Returns a sentence that says why pairs are missing from the list of a snapshot; empty if the list is not truncated.
std::string truncationOf(const Snapshot& snapshot);

}  // namespace hgrid
