// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

#include <ros/node_handle.h>
#include <ros/publisher.h>
#include <visualization_msgs/Marker.h>

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

#include "node/markers/query_markers.h"
#include "node/threads/immediate_callbacks.h"
#include "node/tick/tick.h"

namespace hgrid {

/// Publishes ~markers for RViz while there are subscribers. Every marker has a lifetime and is published again before
/// it ends, so that nothing stays on the screen if the node ends or hangs. Only one thread may use it, but any thread
/// may call subscribed().
class MarkersPublisher {
 public:
  MarkersPublisher(ros::NodeHandle& private_node, const QuerySketch& sketch);

  bool subscribed() const { return publisher_.getNumSubscribers() > 0; }
  /// @param measured  null: nothing was measured
  void publish(const Tick& newest, const std::shared_ptr<const MeasuredTick>& measured);

 private:
  bool haveOthers(const Tick& tick);

  const QuerySketch& sketch_;
  // A viewer came since the last publish(), perhaps after another one had left: then their number is the same.
  std::atomic<bool> viewer_came_{false};
  ImmediateCallbacks immediately_;
  ros::Publisher publisher_;
  std::optional<std::vector<visualization_msgs::Marker>> rooms_;  // roomMarkers(); made at the first publish()
  // Values at the last call of publish(): number of subscribers, revision of the structure, epoch.
  std::size_t viewers_ = 0;
  std::uint64_t revision_ = 0, epoch_ = 0;
};

}  // namespace hgrid
