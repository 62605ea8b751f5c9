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

/// Measures the exact distances of the pairs of a tick and publishes them as ~distances, if somebody needs them. The
/// tick thread does this after it published ~pairs, so that subscribers of ~pairs do not wait for the measurements.
class DistancesPublisher {
 public:
  DistancesPublisher(ros::NodeHandle& private_node, Commons& commons);

  /// Only the tick thread may call this.
  /// @param also_wanted  measure the distances even if ~distances has no subscriber
  void publish(const std::shared_ptr<const Tick>& tick, bool also_wanted);
  /// Returns the newest tick that was measured; null while nobody needs distances. Any thread may call this.
  std::shared_ptr<const MeasuredTick> measured() const { return std::atomic_load(&measured_); }

 private:
  Commons& commons_;
  ros::Publisher publisher_;
  PairMeter meter_;
  std::shared_ptr<const MeasuredTick> measured_;  // accessed by atomic functions only
};

}  // namespace hgrid
