// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

#include <ros/node_handle.h>
#include <ros/publisher.h>

#include <cstddef>
#include <memory>

#include "node/messages/markers.h"
#include "node/params/params.h"
#include "node/tick/tick.h"

namespace hgrid {

/// Publishes ~markers for RViz while there are subscribers. One thread may use it; any thread may call subscribed().
class MarkersPublisher {
 public:
  MarkersPublisher(ros::NodeHandle& private_node, const Params& params, const QuerySketch& sketch);

  bool subscribed() const { return publisher_.getNumSubscribers() > 0; }
  /// @param newest    the tick to show if `measured` has no distances
  /// @param measured  a tick with its distances, which is shown if it has any; may be null
  void publish(const Tick& newest, const std::shared_ptr<const MeasuredTick>& measured);

 private:
  const Params& params_;
  const QuerySketch& sketch_;
  ros::Publisher publisher_;
  std::size_t viewers_ = 0;  // number of subscribers at the last call of publish()
};

}  // namespace hgrid
