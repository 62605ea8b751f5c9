// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#include "node/publishers/streams_publisher.h"

#include "node/messages/events_messages.h"
#include "node/messages/status_message.h"
#include "node/messages/to_messages.h"
#include "node/messages/world_state_message.h"

namespace hgrid {

StreamsPublisher::StreamsPublisher(ros::NodeHandle& private_node, const Commons& commons, const Stopwatch& stopwatch)
    : commons_(commons),
      stopwatch_(stopwatch),
      pairs_(private_node.advertise<msg::Pairs>("pairs", 1)),
      events_(private_node.advertise<msg::Events>("events",
                                                  static_cast<std::uint32_t>(commons.settings.params.event_queue))),
      status_(private_node.advertise<msg::Status>("status", 1)) {}

void StreamsPublisher::publish(const Tick& tick) {
  const Params& params = tick.settings->params;
  const msg::WorldState world = worldState(tick, 0.0);
  if (events_.getNumSubscribers() > 0) {
    for (const auto& message : eventsMessages(tick, world, params, *commons_.narrow_phase)) events_.publish(message);
  }
  if (pairs_.getNumSubscribers() > 0) pairs_.publish(pairs_messages_.of(tick, world));
  if (status_.getNumSubscribers() > 0) {
    status_.publish(boost::make_shared<msg::Status>(statusMessage(tick, world, params, commons_.ledger, stopwatch_)));
  }
}

}  // namespace hgrid
