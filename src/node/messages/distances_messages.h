// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

#include <hgrid_proximity/Distances.h>

#include "hgrid_proximity/distances/pair_meter.h"
#include "node/messages/to_messages.h"
#include "node/messages/world_state_message.h"

namespace hgrid {

/// Returns the message of ~distances.
/// @param distances  the distances of the tick's snapshot; null if there are none
boost::shared_ptr<msg::Distances> distancesMessage(const Tick& tick, const msg::WorldState& world,
                                                   const PairDistances* distances, const Params& params);

}  // namespace hgrid
