// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#include "node/markers/room_markers.h"

#include "hgrid_proximity/broadphase/room_edges.h"
#include "node/markers/marker_parts.h"
#include "node/messages/to_messages.h"

namespace hgrid {
namespace {

using visualization_msgs::Marker;

constexpr double kRoomEdgeWidth = 0.02, kRoomTextHeight = 0.2;  // [m]
constexpr double kFarthestCorner = 2e6;                         // [m] larger than any coordinate of a room
constexpr double kBeyond = 2.0;                                 // [m] see roomMarkers()

/// Returns the box around all corners of rooms and doors, apart from those where open rooms are cut off.
Eigen::AlignedBox3d extentOf(const Params& params) {
  const Eigen::Vector3d far = Eigen::Vector3d::Constant(kFarthestCorner);
  Eigen::AlignedBox3d extent;
  const auto add = [&](const Room& room) {
    for (const RoomEdge& edge : edgesOf(room, {-far, far})) {
      for (const Eigen::Vector3d& corner : {edge.from, edge.to}) {
        if (corner.cwiseAbs().maxCoeff() < 0.99 * kFarthestCorner) extent.extend(corner);
      }
    }
  };
  for (const Room& room : params.rooms) add(room);
  for (const Portal& door : params.doors) add(Room::ofBox("", door.opening));
  if (extent.isEmpty()) extent.extend(Eigen::Vector3d::Zero().eval());
  return {extent.min() - Eigen::Vector3d::Constant(kBeyond), extent.max() + Eigen::Vector3d::Constant(kBeyond)};
}

/// Adds the edges of a room to a marker. @returns the box around them
Eigen::AlignedBox3d addEdges(const Room& room, const Eigen::AlignedBox3d& extent, Marker& lines) {
  for (const RoomEdge& edge : edgesOf(room, extent)) addLine(lines, edge.from, edge.to, lines.color);
  return boundsOf(room, extent);
}

Marker linesOf(const Tick& tick, const char* name_space, const std_msgs::ColorRGBA& color) {
  Marker lines = markerOf(tick, name_space, 0, Marker::LINE_LIST);
  lines.scale.x = kRoomEdgeWidth;
  lines.color = color;
  return lines;
}

/// Returns a text above a place. @param id  greater than 0, which is the id of the lines
Marker textAt(const Tick& tick, const Marker& lines, std::size_t id, const Eigen::Vector3d& place,
              const std::string& words) {
  Marker text = markerOf(tick, lines.ns.c_str(), static_cast<int>(id), Marker::TEXT_VIEW_FACING);
  text.action = Marker::ADD;
  text.color = lines.color;
  text.scale.z = kRoomTextHeight;
  text.pose.position = toPoint(place);
  text.text = words;
  return text;
}

}  // namespace

std::vector<Marker> roomMarkers(const Tick& tick) {
  const Params& params = tick.settings->params;
  if (params.rooms.empty()) return {};
  const Eigen::AlignedBox3d extent = extentOf(params);
  Marker rooms = linesOf(tick, "rooms", rgba(0.34, 0.71, 0.91, 0.6)),
         doors = linesOf(tick, "doors", rgba(0.0, 0.62, 0.45, 0.9));
  std::vector<Marker> texts;
  for (std::size_t i = 0; i < params.rooms.size(); ++i) {
    const Eigen::AlignedBox3d around = addEdges(params.rooms[i], extent, rooms);
    if (!around.isEmpty()) texts.push_back(textAt(tick, rooms, i + 1, around.center(), params.rooms[i].name));
  }
  for (std::size_t i = 0; i < params.doors.size(); ++i) {
    const Portal& door = params.doors[i];
    const Eigen::AlignedBox3d around = addEdges(Room::ofBox("", door.opening), extent, doors);
    const std::string sides = params.rooms[door.rooms[0]].name + " - " + params.rooms[door.rooms[1]].name;
    texts.push_back(textAt(tick, doors, i + 1, around.center(), sides));
  }
  texts.push_back(std::move(rooms));
  texts.push_back(std::move(doors));
  return texts;
}

}  // namespace hgrid
