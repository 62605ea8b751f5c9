// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#include "node/messages/marker_parts.h"

#include "node/messages/to_messages.h"

namespace hgrid {

using visualization_msgs::Marker;

std_msgs::ColorRGBA rgba(double red, double green, double blue, double alpha) {
  std_msgs::ColorRGBA color;
  color.r = static_cast<float>(red);
  color.g = static_cast<float>(green);
  color.b = static_cast<float>(blue);
  color.a = static_cast<float>(alpha);
  return color;
}

Marker markerOf(const Tick& tick, const char* name_space, int id, int type) {
  Marker marker;
  marker.header = headerOf(tick);
  marker.ns = name_space;
  marker.id = id;
  marker.type = type;
  marker.action = Marker::DELETE;
  marker.pose.orientation.w = 1.0;
  marker.scale.x = marker.scale.y = marker.scale.z = 0.01;
  marker.color = rgba(1.0, 1.0, 1.0, 1.0);
  return marker;
}

void addLine(Marker& lines, const Eigen::Vector3d& from, const Eigen::Vector3d& to, const std_msgs::ColorRGBA& color) {
  lines.action = Marker::ADD;
  for (const Eigen::Vector3d& end : {from, to}) {
    lines.points.push_back(toPoint(end));
    lines.colors.push_back(color);
  }
}

Marker deleteAll(const Tick& tick) {
  Marker marker = markerOf(tick, "shapes", 0, Marker::CUBE);
  marker.action = Marker::DELETEALL;
  return marker;
}

}  // namespace hgrid
