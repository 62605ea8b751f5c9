// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

#include <ros/node_handle.h>
#include <ros/publisher.h>

#include <chrono>
#include <memory>
#include <optional>

#include "hgrid_proximity/distances/pair_meter.h"
#include "node/health/commons.h"
#include "node/threads/newest_only.h"
#include "node/tick/tick.h"

namespace hgrid {

/// Measures the exact distances of the pairs of a tick and publishes them as ~distances, if somebody needs them.
///
/// A separate thread does this, so neither ticks nor ~pairs wait for measurements. If the measurements of a tick take
/// longer than a period, the thread continues with the newest tick. The ticks between the two have no ~distances.
class DistancesPublisher {
 public:
  DistancesPublisher(ros::NodeHandle& private_node, Commons& commons);

  /// Passes a tick to the measuring thread, and never waits for it. Only the tick thread may call this.
  /// @param also_wanted  measure the distances even if ~distances has no subscriber
  /// @returns how long the last measurements took, if they ended after the last call
  std::optional<std::chrono::nanoseconds> publish(const std::shared_ptr<const Tick>& tick, bool also_wanted);
  /// Returns the newest tick that was measured; null while nobody needs distances. Any thread may call this.
  std::shared_ptr<const MeasuredTick> measured() const { return std::atomic_load(&measured_); }

 private:
  struct Request {
    std::shared_ptr<const Tick> tick;  // null: nobody needs distances any more
    bool published = false;            // whether ~distances has a subscriber
  };
  void measure(const Request& request);

  Commons& commons_;
  ros::Publisher publisher_;
  // Results of the last call of publish():
  bool needed_ = false;                           // whether somebody needed distances
  std::shared_ptr<const MeasuredTick> reported_;  // the measurements whose duration it has returned
  PairMeter meter_;                               // only the measuring thread uses it
  std::shared_ptr<const MeasuredTick> measured_;  // accessed by atomic functions only
  NewestOnly<Request> thread_;                    // declared last, because its thread uses the members above
};

}  // namespace hgrid
