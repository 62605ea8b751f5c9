// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#include "node/publishers/publishers.h"

namespace hgrid {

Publishers::Publishers(ros::NodeHandle tick_node, ros::NodeHandle admin_node, Commons& commons,
                       const Stopwatch& stopwatch, const QuerySketch& sketch)
    : streams_(tick_node, commons, stopwatch),
      structure_(tick_node, commons),
      distances_(tick_node, commons),
      markers_(admin_node, sketch) {}

void Publishers::publishTick(const std::shared_ptr<const Tick>& tick) {
  streams_.publish(*tick);
  structure_.publish(tick);
}

std::optional<std::chrono::nanoseconds> Publishers::publishDistances(const std::shared_ptr<const Tick>& tick) {
  return distances_.publish(tick, markers_.subscribed());
}

void Publishers::publishMarkers(const std::shared_ptr<const Tick>& newest) {
  if (newest) markers_.publish(*newest, distances_.measured());
}

}  // namespace hgrid
