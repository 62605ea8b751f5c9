// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

#include <ros/node_handle.h>

#include <memory>

#include "node/commons.h"
#include "node/publishers/bodies_publisher.h"
#include "node/publishers/distances_publisher.h"
#include "node/publishers/markers_publisher.h"
#include "node/publishers/rules_publisher.h"
#include "node/publishers/streams_publisher.h"

namespace hgrid {

/// Owns the publishers of the node: each topic has one.
class Publishers {
 public:
  /// @param tick_node   private node handle of the tick thread
  /// @param admin_node  private node handle of the admin thread
  Publishers(ros::NodeHandle tick_node, ros::NodeHandle admin_node, Commons& commons, const Stopwatch& stopwatch,
             const QuerySketch& sketch);

  /// Publishes what every tick has: ~events, ~pairs, ~status, and ~bodies and ~rules if they changed. Tick thread.
  void publishTick(const Tick& tick);
  /// Measures and publishes ~distances. Tick thread.
  void publishDistances(const std::shared_ptr<const Tick>& tick);
  /// Publishes ~markers. Admin thread. @param newest  null before the first tick
  void publishMarkers(const std::shared_ptr<const Tick>& newest);

 private:
  StreamsPublisher streams_;
  BodiesPublisher bodies_;
  RulesPublisher rules_;
  DistancesPublisher distances_;
  MarkersPublisher markers_;
};

}  // namespace hgrid
