// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#include "node/markers/marker_parts.h"

#include <algorithm>

#include "node/messages/to_messages.h"

namespace hgrid {

using visualization_msgs::Marker;

Marker markerOf(const Tick& tick, const char* name_space, int id, int type) {
  Marker marker;
  marker.header = headerOf(tick);
  marker.ns = name_space;
  marker.id = id;
  marker.type = type;
  marker.action = Marker::DELETE;
  marker.pose.orientation.w = 1.0;
  marker.scale.x = marker.scale.y = marker.scale.z = 0.01;
  marker.color = white();
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

std::vector<Label> joinedLabels(const std::vector<Label>& labels, double apart, const char* separator) {
  std::vector<Label> joined;
  for (const Label& label : labels) {
    const auto near = std::find_if(joined.begin(), joined.end(),
                                   [&](const Label& other) { return (other.place - label.place).norm() < apart; });
    if (near == joined.end()) {
      joined.push_back(label);
    } else {
      near->text += separator + label.text;
    }
  }
  return joined;
}

std::vector<Marker> textsOf(const Tick& tick, const char* name_space, std::size_t count, double height,
                            const std::vector<Label>& labels) {
  std::vector<Marker> texts;
  for (std::size_t i = 0; i < count; ++i) {
    texts.push_back(markerOf(tick, name_space, static_cast<int>(i), Marker::TEXT_VIEW_FACING));
    texts.back().scale.z = height;
    if (i >= labels.size()) continue;
    texts.back().action = Marker::ADD;
    texts.back().text = labels[i].text;
    texts.back().pose.position = toPoint(labels[i].place);
  }
  return texts;
}

}  // namespace hgrid
