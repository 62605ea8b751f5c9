// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

#include <visualization_msgs/Marker.h>

#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "hgrid_proximity/narrow/core_narrow_phase.h"
#include "src/node/markers/near_pairs.h"
#include "test/node/support/settings.h"
#include "test/support/scenes.h"

namespace hgrid {
namespace test {

/// Returns a tick with a snapshot and default parameters. The world frame is "world".
inline Tick tickWith(std::shared_ptr<const Snapshot> snapshot) {
  Tick tick;
  tick.settings = settingsOf(Params());
  tick.world_frame = "world";
  tick.snapshot = std::move(snapshot);
  return tick;
}

inline Tick tickOf(Scene& scene) { return tickWith(scene.commit(Time{1}, {})); }

inline Body bodyOf(const std::string& name, const Shape& shape, double padding = 0.0) {
  Body body = obstacle(name);
  body.shapes.push_back(shapeOf(shape));
  body.shapes.back().padding = padding;
  return body;
}

/// Returns a sphere that can be measured. @param kind  the source of a link is the robot "arm"
inline Body measuredBall(const std::string& name, double radius, BodyKind kind = BodyKind::obstacle) {
  static const std::shared_ptr<NarrowPhase> narrow_phase = makeCoreNarrowPhase();
  Body body = bodyOf(name, Shape::sphere(radius));
  body.kind = kind;
  if (kind == BodyKind::track) body.name = "track/people/" + name;
  body.shapes[0].solid = narrow_phase->solidOf(body.shapes[0].shape);
  return body;
}

/// Measures the pairs of a tick up to the margin.
inline std::shared_ptr<const PairDistances> distancesOf(const Tick& tick) {
  return PairMeter(makeCoreNarrowPhase(), MeterOptions()).measure(*tick.snapshot);
}

/// Returns the markers of a namespace that are shown.
inline std::vector<visualization_msgs::Marker> shownOf(const std::vector<visualization_msgs::Marker>& markers,
                                                       const std::string& name_space) {
  std::vector<visualization_msgs::Marker> shown;
  for (const visualization_msgs::Marker& marker : markers) {
    if (marker.ns == name_space && marker.action == visualization_msgs::Marker::ADD) shown.push_back(marker);
  }
  return shown;
}

inline Eigen::Vector3d placeOf(const visualization_msgs::Marker& marker) {
  return {marker.pose.position.x, marker.pose.position.y, marker.pose.position.z};
}

inline std::vector<float> rgbOf(const visualization_msgs::Marker& marker) {
  return {marker.color.r, marker.color.g, marker.color.b};
}

}  // namespace test
}  // namespace hgrid
