// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#include "node/publishers/markers_publisher.h"

#include <visualization_msgs/MarkerArray.h>

#include <utility>
#include <vector>

#include "node/messages/map_markers.h"
#include "node/messages/marker_parts.h"
#include "node/messages/pair_markers.h"
#include "node/messages/room_markers.h"
#include "node/messages/shape_markers.h"
#include "node/messages/to_messages.h"

namespace hgrid {

MarkersPublisher::MarkersPublisher(ros::NodeHandle& private_node, const QuerySketch& sketch)
    : sketch_(sketch), publisher_(private_node.advertise<visualization_msgs::MarkerArray>("markers", 1)) {}

void MarkersPublisher::publish(const Tick& newest, const std::shared_ptr<const MeasuredTick>& measured) {
  const std::size_t viewers = publisher_.getNumSubscribers();
  const bool new_viewer = viewers > std::exchange(viewers_, viewers);
  if (viewers == 0) return;
  const bool has_distances = measured && measured->distances;
  const Tick& shown = has_distances ? *measured->tick : newest;
  visualization_msgs::MarkerArray array;
  const auto add = [&array](std::vector<visualization_msgs::Marker> markers) {
    array.markers.insert(array.markers.end(), markers.begin(), markers.end());
  };
  if (new_viewer || haveOthers(shown)) add({deleteAll(shown)});
  add(shapeMarkers(shown));
  add({boxMarker(shown)});
  add(stateMarkers(shown));
  add(pairMarkers(shown, has_distances ? measured->distances.get() : nullptr));
  add(queryMarkers(shown, sketch_));
  add(mapMarkers(shown, shown.settings->params));
  if (!rooms_) rooms_ = roomMarkers(shown);
  for (visualization_msgs::Marker& marker : *rooms_) marker.header = headerOf(shown);
  add(*rooms_);
  publisher_.publish(array);
}

/// Returns whether the id of a marker may now belong to another shape than at the last call.
bool MarkersPublisher::haveOthers(const Tick& tick) {
  const std::uint64_t revision = tick.snapshot ? tick.snapshot->structure().revision : 0;
  const bool others = revision != revision_ || tick.epoch != epoch_;
  revision_ = revision;
  epoch_ = tick.epoch;
  return others;
}

}  // namespace hgrid
