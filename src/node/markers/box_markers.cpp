// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#include "node/markers/box_markers.h"

#include <algorithm>

#include "node/markers/marker_parts.h"

namespace hgrid {
namespace {

using visualization_msgs::Marker;

/// Returns the color of a level of the grid. People who confuse red and green can distinguish the colors, too (after
/// Okabe and Ito, 2008).
std_msgs::ColorRGBA levelColor(int level) {
  static const std_msgs::ColorRGBA kColors[] = {rgba(0.34, 0.71, 0.91, 0.9), rgba(0.90, 0.62, 0.00, 0.9),
                                                rgba(0.00, 0.62, 0.45, 0.9), rgba(0.80, 0.47, 0.65, 0.9),
                                                rgba(0.94, 0.89, 0.26, 0.9), rgba(0.00, 0.45, 0.70, 0.9)};
  return kColors[static_cast<std::size_t>(std::max(level, 0)) % 6];
}

void addEdges(Marker& lines, const Aabb& box, const Eigen::Vector3d& origin, const std_msgs::ColorRGBA& color) {
  const auto corner = [&](int bits) {
    Eigen::Vector3d point;
    for (int axis = 0; axis < 3; ++axis)
      point[axis] = origin[axis] + (bits >> axis & 1 ? box.max[axis] : box.min[axis]);
    return point;
  };
  for (int bits = 0; bits < 8; ++bits) {
    for (int axis = 0; axis < 3; ++axis) {
      if ((bits >> axis & 1) == 0) addLine(lines, corner(bits), corner(bits | 1 << axis), color);
    }
  }
}

}  // namespace

Marker boxMarker(const Tick& tick, const MarkerScale& scale) {
  Marker boxes = markerOf(tick, "boxes", 0, Marker::LINE_LIST);
  boxes.scale.x = 0.05 * scale.text_height;
  if (!tick.snapshot) return boxes;
  const Snapshot& snapshot = *tick.snapshot;
  for (ProxyId proxy = 0; proxy < snapshot.boxes().size(); ++proxy) {
    if (snapshot.poses()[snapshot.structure().body_of_proxy[proxy]].state == Freshness::unplaced) continue;
    if (snapshot.structure().isPlane(proxy)) continue;  // it has no box
    addEdges(boxes, snapshot.boxes()[proxy], snapshot.origin(), levelColor(snapshot.broadPhase().levelOf(proxy)));
  }
  return boxes;
}

Marker trackMarker(const Tick& tick, const MarkerScale& scale) {
  Marker frames = markerOf(tick, "tracks", 0, Marker::LINE_LIST);
  frames.scale.x = 0.15 * scale.text_height;
  if (!tick.snapshot) return frames;
  const Snapshot& snapshot = *tick.snapshot;
  const Structure& structure = snapshot.structure();
  for (std::uint32_t body = 0; body < structure.bodies.size(); ++body) {
    const Freshness state = snapshot.poses()[body].state;
    if (structure.bodies[body].kind != BodyKind::track || state == Freshness::unplaced) continue;
    Aabb around = snapshot.boxes()[structure.first_proxy[body]];
    for (ProxyId proxy = structure.first_proxy[body]; proxy < structure.first_proxy[body + 1]; ++proxy) {
      around.min = around.min.cwiseMin(snapshot.boxes()[proxy].min);
      around.max = around.max.cwiseMax(snapshot.boxes()[proxy].max);
    }
    std_msgs::ColorRGBA color = colorOfBody(BodyKind::track, state, std::nullopt);
    color.a = 1.0f;
    addEdges(frames, around, snapshot.origin(), color);
  }
  return frames;
}

}  // namespace hgrid
