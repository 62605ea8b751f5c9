// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#include "node/markers/query_markers.h"

#include <algorithm>

#include "node/markers/marker_parts.h"
#include "node/messages/to_messages.h"

namespace hgrid {
namespace {

using visualization_msgs::Marker;

constexpr auto kShownFor = std::chrono::seconds(3);

std_msgs::ColorRGBA colorOf(Verdict verdict) {
  if (verdict == Verdict::hit) return orange(0.5);
  return verdict == Verdict::clear ? rgba(0.0, 0.62, 0.45, 0.5) : gray(0.5);
}

}  // namespace

void QuerySketch::show(const Sphere& sphere, Verdict verdict) {
  const std::lock_guard<std::mutex> lock(mutex_);
  sphere_ = Drawn<Sphere>{sphere, verdict, std::chrono::steady_clock::now()};
}

void QuerySketch::show(const Segment& segment, Verdict verdict) {
  const std::lock_guard<std::mutex> lock(mutex_);
  segment_ = Drawn<Segment>{segment, verdict, std::chrono::steady_clock::now()};
}

std::optional<QuerySketch::Drawn<Sphere>> QuerySketch::sphere() const {
  const std::lock_guard<std::mutex> lock(mutex_);
  return sphere_;
}

std::optional<QuerySketch::Drawn<Segment>> QuerySketch::segment() const {
  const std::lock_guard<std::mutex> lock(mutex_);
  return segment_;
}

std::vector<Marker> queryMarkers(const Tick& tick, const QuerySketch& queries) {
  Marker solid = markerOf(tick, "queries", 0, Marker::SPHERE), line = markerOf(tick, "queries", 1, Marker::LINE_LIST);
  const auto now = std::chrono::steady_clock::now();
  const auto sphere = queries.sphere();
  if (sphere && now - sphere->at < kShownFor) {
    solid.action = Marker::ADD;
    solid.pose.position = toPoint(sphere->geometry.center);
    solid.scale.x = solid.scale.y = solid.scale.z = std::max(0.02, 2.0 * sphere->geometry.radius);
    solid.color = colorOf(sphere->verdict);
  }
  const auto segment = queries.segment();
  if (segment && now - segment->at < kShownFor) {
    line.scale.x = std::max(0.01, 2.0 * segment->geometry.radius);
    addLine(line, segment->geometry.from, segment->geometry.to, colorOf(segment->verdict));
  }
  return {solid, line};
}

}  // namespace hgrid
