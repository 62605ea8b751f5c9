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

/// Publishes ~markers for RViz while somebody listens. Used by one thread; subscribed() may be called by any.
class MarkersPublisher {
 public:
  MarkersPublisher(ros::NodeHandle& private_node, const Params& params, const QuerySketch& sketch);

  bool subscribed() const { return publisher_.getNumSubscribers() > 0; }
  /// @param measured  null: no distances are drawn
  void publish(const Tick& newest, const std::shared_ptr<const MeasuredTick>& measured);

 private:
  const Params& params_;
  const QuerySketch& sketch_;
  ros::Publisher publisher_;
  std::size_t viewers_ = 0;  // at the last call of publish()
};

}  // namespace hgrid
