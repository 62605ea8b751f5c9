// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

#include <ros/node_handle.h>
#include <ros/publisher.h>

#include <memory>

#include "hgrid_proximity/distances/pair_meter.h"
#include "node/commons.h"
#include "node/tick/tick.h"

namespace hgrid {

/// Measures the exact distances of a tick's pairs and publishes them as ~distances, if somebody wants them. This comes
/// after ~pairs, so that those who need no distances do not wait for them.
class DistancesPublisher {
 public:
  DistancesPublisher(ros::NodeHandle& private_node, Commons& commons);

  /// Only the tick thread may call this. @param also_wanted  somebody beside the subscribers wants the distances
  void publish(const std::shared_ptr<const Tick>& tick, bool also_wanted);
  /// The newest tick that was measured; null while nobody wants distances. Any thread.
  std::shared_ptr<const MeasuredTick> measured() const { return std::atomic_load(&measured_); }

 private:
  Commons& commons_;
  ros::Publisher publisher_;
  PairMeter meter_;
  std::shared_ptr<const MeasuredTick> measured_;  // atomic access only
};

}  // namespace hgrid
