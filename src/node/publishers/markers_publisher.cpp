// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#include "node/publishers/markers_publisher.h"

#include <utility>
#include <vector>

#include "node/messages/map_markers.h"

namespace hgrid {

MarkersPublisher::MarkersPublisher(ros::NodeHandle& private_node, const Params& params, const QuerySketch& sketch)
    : params_(params),
      sketch_(sketch),
      publisher_(private_node.advertise<visualization_msgs::MarkerArray>("markers", 1)) {}

void MarkersPublisher::publish(const Tick& newest, const std::shared_ptr<const MeasuredTick>& measured) {
  const std::size_t viewers = publisher_.getNumSubscribers();
  const bool is_new = viewers > std::exchange(viewers_, viewers);
  if (viewers == 0) return;
  if (is_new) publisher_.publish(markersGone(newest));
  const bool has_distances = measured && measured->distances;
  const Tick& shown = has_distances ? *measured->tick : newest;
  visualization_msgs::MarkerArray array = markers(shown, sketch_, has_distances ? measured->distances.get() : nullptr);
  const std::vector<visualization_msgs::Marker> cells = mapMarkers(shown, params_);
  array.markers.insert(array.markers.end(), cells.begin(), cells.end());
  publisher_.publish(array);
}

}  // namespace hgrid
