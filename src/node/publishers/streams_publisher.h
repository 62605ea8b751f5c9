// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

#include <ros/node_handle.h>
#include <ros/publisher.h>

#include <memory>

#include "node/health/commons.h"
#include "node/messages/pairs_messages.h"
#include "node/threads/stopwatch.h"
#include "node/tick/tick.h"

namespace hgrid {

/// Publishes ~events, ~pairs and ~status of every tick, in this order. So the events of a tick are sent before the
/// message that contains the number of the newest event. Only the tick thread may use it.
class StreamsPublisher {
 public:
  StreamsPublisher(ros::NodeHandle& private_node, const Commons& commons, const Stopwatch& stopwatch);

  void publish(const Tick& tick);

 private:
  const Commons& commons_;
  const Stopwatch& stopwatch_;
  ros::Publisher pairs_, events_, status_;
  PairsMessages pairs_messages_;
};

}  // namespace hgrid
