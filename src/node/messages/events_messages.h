// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

#include <hgrid_proximity/Events.h>

#include <vector>

#include "node/messages/to_messages.h"
#include "node/messages/world_state_message.h"

namespace hgrid {

/// The messages of ~events of a tick: none where nothing began or ended, and more than one where there are more events
/// than ~max_events. WorldState.last_event of each is its own last one, so that what is still to come does not look
/// missed. Distances are measured as long as a fifth of ~distances/budget lasts.
std::vector<boost::shared_ptr<msg::Events>> eventsMessages(const Tick& tick, const msg::WorldState& world,
                                                           const Params& params, const NarrowPhase& narrow_phase);

}  // namespace hgrid
