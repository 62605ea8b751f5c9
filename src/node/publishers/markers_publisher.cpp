// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#include "node/publishers/markers_publisher.h"

#include <visualization_msgs/MarkerArray.h>

#include <chrono>
#include <utility>
#include <vector>

#include "node/markers/box_markers.h"
#include "node/markers/map_markers.h"
#include "node/markers/marker_parts.h"
#include "node/markers/pair_markers.h"
#include "node/markers/room_markers.h"
#include "node/markers/shape_markers.h"
#include "node/markers/state_markers.h"
#include "node/markers/verdict_markers.h"
#include "node/messages/to_messages.h"
#include "node/publishers/shown_tick.h"

namespace hgrid {

MarkersPublisher::MarkersPublisher(ros::NodeHandle& private_node, const QuerySketch& sketch)
    : sketch_(sketch) {
  auto options = ros::AdvertiseOptions::create<visualization_msgs::MarkerArray>(
      "markers", 1, [this](const ros::SingleSubscriberPublisher&) { viewer_came_ = true; },
      ros::SubscriberStatusCallback(), ros::VoidConstPtr(), &immediately_);
  publisher_ = private_node.advertise(options);
}

void MarkersPublisher::publish(const Tick& newest, const std::shared_ptr<const MeasuredTick>& measured) {
  const std::size_t viewers = publisher_.getNumSubscribers();
  // roscpp counts a viewer before it calls back, so the number alone may tell of one, too.
  const bool more_viewers = viewers > std::exchange(viewers_, viewers);
  if (viewers == 0) return;
  const ShownTick chosen = shownTick(newest, measured.get(), std::chrono::steady_clock::now());
  if (chosen.tick == nullptr) return;  // RViz removes the markers when their lifetime ends
  const Tick& shown = *chosen.tick;
  const NearPairs near = nearPairs(shown, chosen.distances);
  const MarkerScale scale = scaleOf(shown);
  visualization_msgs::MarkerArray array;
  const auto add = [&array](std::vector<visualization_msgs::Marker> markers) {
    array.markers.insert(array.markers.end(), markers.begin(), markers.end());
  };
  const bool viewer_came = viewer_came_.exchange(false) || more_viewers;
  if (haveOthers(shown) || viewer_came) add({deleteAll(shown)});
  add(shapeMarkers(shown, near));
  add({boxMarker(shown, scale), trackMarker(shown, scale)});
  add(stateMarkers(shown, scale));
  add(pairMarkers(shown, near, scale));
  add(verdictMarkers(shown, near, scale));
  add(queryMarkers(shown, sketch_));
  add(mapMarkers(shown, shown.settings->params));
  if (!rooms_) rooms_ = roomMarkers(shown);
  for (visualization_msgs::Marker& marker : *rooms_) marker.header = headerOf(shown);
  add(*rooms_);
  const ros::Duration lifetime(markerLifetime(shown.settings->params).count());
  for (visualization_msgs::Marker& marker : array.markers) marker.lifetime = lifetime;
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
