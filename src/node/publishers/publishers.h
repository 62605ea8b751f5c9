// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

#include <ros/node_handle.h>

#include <chrono>
#include <memory>
#include <optional>

#include "node/health/commons.h"
#include "node/publishers/distances_publisher.h"
#include "node/publishers/markers_publisher.h"
#include "node/publishers/streams_publisher.h"
#include "node/publishers/structure_publisher.h"

namespace hgrid {

/// Owns the publishers of all topics of the node.
class Publishers {
 public:
  /// @param tick_node   private node handle of the tick thread
  /// @param admin_node  private node handle of the admin thread
  Publishers(ros::NodeHandle tick_node, ros::NodeHandle admin_node, Commons& commons, const Stopwatch& stopwatch,
             const QuerySketch& sketch);

  /// Publishes ~events, ~pairs and ~status. Starts to publish ~bodies and ~rules if they changed. The tick thread calls
  /// this.
  void publishTick(const std::shared_ptr<const Tick>& tick);
  /// Waits until ~bodies and ~rules show the newest published tick, see StructurePublisher::wait(). Any thread except
  /// the tick thread may call this.
  void waitForStructure() { structure_.wait(); }
  /// Starts to measure and publish ~distances, see DistancesPublisher::publish(). The tick thread calls this.
  std::optional<std::chrono::nanoseconds> publishDistances(const std::shared_ptr<const Tick>& tick);
  /// Publishes ~markers. The admin thread calls this. @param newest  null before the first tick
  void publishMarkers(const std::shared_ptr<const Tick>& newest);

 private:
  StreamsPublisher streams_;
  StructurePublisher structure_;
  DistancesPublisher distances_;
  MarkersPublisher markers_;
};

}  // namespace hgrid
