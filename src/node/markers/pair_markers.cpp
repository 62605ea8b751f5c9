// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#include "node/markers/pair_markers.h"

#include <algorithm>
#include <cmath>
#include <string>

#include "node/markers/marker_parts.h"

namespace hgrid {
namespace {

using visualization_msgs::Marker;

/// Returns the worse state of the two poses.
Freshness stateOf(const Snapshot& snapshot, const DrawnPair& pair) {
  return std::max(snapshot.poses()[pair.first].state, snapshot.poses()[pair.second].state);
}

std::string lineOf(const Snapshot& snapshot, const DrawnPair& pair) {
  const BodyList& bodies = snapshot.structure().bodies;
  const std::string millimeters = std::to_string(std::lround(1e3 * pair.distance)) + " mm";
  const std::string distance = !pair.measured        ? "at least " + millimeters
                               : pair.status.empty() ? millimeters
                                                     : pair.status;
  const Freshness state = stateOf(snapshot, pair);
  return bodies[pair.first].name + " to " + bodies[pair.second].name + ": " + distance +
         (state >= Freshness::stale ? std::string(", ") + name(state) : "");
}

}  // namespace

std::vector<Marker> pairMarkers(const Tick& tick, const NearPairs& near, const MarkerScale& scale) {
  std::vector<Marker> markers = {markerOf(tick, "pairs", 0, Marker::LINE_LIST),
                                 markerOf(tick, "pairs", 1, Marker::SPHERE_LIST)};
  markers[0].scale.x = 0.1 * scale.text_height;
  markers[1].scale.x = markers[1].scale.y = markers[1].scale.z = 0.25 * scale.text_height;
  std::vector<Label> numbers;
  for (const DrawnPair& pair : near.drawn) {
    const bool listed = numbers.size() < kMostListed;
    std_msgs::ColorRGBA color = pair.measured && stateOf(*tick.snapshot, pair) < Freshness::stale ? white() : gray(1.0);
    if (!listed) color.a = 0.3f;  // so many lines would hide the shapes
    addLine(markers[0], pair.on_first, pair.on_second, color);
    addLine(markers[1], pair.on_first, pair.on_second, color);
    if (!listed) continue;
    Eigen::Vector3d place = 0.5 * (pair.on_first + pair.on_second);
    place.z() += scale.text_height;  // beside the line, not on it
    numbers.push_back({place, std::to_string(numbers.size() + 1)});
  }
  constexpr double kApart = 2.0;  // [text heights] a number of one digit is less wide
  for (Marker& text : textsOf(tick, "pair_numbers", kMostListed, scale.text_height,
                              joinedLabels(numbers, kApart * scale.text_height, ","))) {
    markers.push_back(std::move(text));
  }
  return markers;
}

std::string listText(const Tick& tick, const NearPairs& near) {
  std::string text;
  for (std::size_t i = 0; i < std::min(kMostListed, near.drawn.size()); ++i) {
    if (i > 0) text += '\n';
    text += std::to_string(i + 1) + ". " + lineOf(*tick.snapshot, near.drawn[i]);
  }
  return text;
}

}  // namespace hgrid
