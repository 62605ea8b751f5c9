// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

#include <hgrid_proximity/Events.h>

#include <vector>

#include "node/messages/to_messages.h"
#include "node/messages/world_state_message.h"

namespace hgrid {

/// Returns the messages of ~events for a tick: none if no pair began or ended, several if there are more events than
/// ~limits/max_events. WorldState.last_event of each message is the number of the last event in that message. If it were the
/// last event of the tick, a receiver would count the events of the next message as lost. Distances are measured until
/// a fifth of ~distances/budget is used up.
std::vector<boost::shared_ptr<msg::Events>> eventsMessages(const Tick& tick, const msg::WorldState& world,
                                                           const Params& params, const NarrowPhase& narrow_phase);

}  // namespace hgrid
