// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

#include <hgrid_proximity/Distances.h>

#include "hgrid_proximity/distances/pair_meter.h"
#include "node/messages/to_messages.h"
#include "node/messages/world_state_message.h"

namespace hgrid {

/// The message of ~distances. @param distances  of the tick's snapshot; null where there is none
boost::shared_ptr<msg::Distances> distancesMessage(const Tick& tick, const msg::WorldState& world,
                                                   const PairDistances* distances, const Params& params);

}  // namespace hgrid
