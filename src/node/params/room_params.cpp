// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#include "node/params/room_params.h"

#include <algorithm>
#include <set>
#include <string>

#include "hgrid_proximity/broadphase/room_edges.h"
#include "hgrid_proximity/geometry/oriented_box.h"
#include "hgrid_proximity/refusal.h"
#include "node/params/obstacle_params.h"
#include "node/params/room_overlaps.h"

namespace hgrid {
namespace {

constexpr std::size_t kMostRooms = 1000, kMostDoors = 4000, kMostWalls = 64;
constexpr double kFarthestWall = 1e6;  // [m] largest offset of a wall and largest side of a room or door
constexpr double kShortestNormal = 1e-6;

/// Adds an error if a list is too long.
void checkCount(const ParamValue& value, std::size_t count, std::size_t most, const char* what) {
  if (count <= most) return;
  value.error("has " + std::to_string(count) + " " + what + "; at most " + std::to_string(most) + " are allowed");
}

/// Reads the members pose and size. The pose is in the world frame. If the size is not valid, all sides are 0.
OrientedBox readBox(ParamValue& element) {
  OrientedBox box{Pose::Identity(), Eigen::Vector3d::Zero()};
  if (auto pose = element.get("pose")) box.world_from_box = readPose(*pose);
  auto size = element.require("size");
  if (!size) return box;
  Eigen::Vector3d given = Eigen::Vector3d::Ones();
  size->vector(given, kFarthestWall);
  if (given.minCoeff() > 0.0) {
    box.size = given;
  } else {
    size->error("has a side of " + text(given.minCoeff()) + " m; each side must be greater than 0 m");
  }
  return box;
}

void addWalls(const OrientedBox& box, Room& room) {
  for (int axis = 0; axis < 3; ++axis) {
    const Eigen::Vector3d normal = box.world_from_box.linear().col(axis);
    const double middle = normal.dot(box.world_from_box.translation()), half = 0.5 * box.size[axis];
    room.walls.push_back({normal, middle + half});
    room.walls.push_back({-normal, half - middle});
  }
}

void readWall(ParamValue& element, Room& room) {
  if (!element.requireStruct()) return;
  RoomWall wall;
  if (auto normal = element.require("normal")) {
    normal->vector(wall.normal, kFarthestWall);
    const double length = wall.normal.norm();
    if (length < kShortestNormal) {
      normal->error("has the length " + text(length) + "; it must be at least " + text(kShortestNormal));
    } else {
      wall.normal /= length;
    }
  }
  if (auto offset = element.require("offset")) offset->number(wall.offset, -kFarthestWall, kFarthestWall, "m");
  element.finish("field of a wall (normal, offset)");
  room.walls.push_back(wall);
}

void readWalls(ParamValue value, Room& room) {
  std::vector<ParamValue> list = value.elements();
  if (list.empty()) value.error("has no wall; it must have at least one");
  checkCount(value, list.size(), kMostWalls, "walls");
  if (list.size() > kMostWalls) return;
  for (ParamValue& wall : list) readWall(wall, room);
  const auto is_valid = [](const RoomWall& wall) { return wall.normal.norm() >= kShortestNormal; };
  const bool all_valid = !room.walls.empty() && std::all_of(room.walls.begin(), room.walls.end(), is_valid);
  const Eigen::AlignedBox3d all_space(Eigen::Vector3d::Constant(-2.0 * kFarthestWall),
                                      Eigen::Vector3d::Constant(2.0 * kFarthestWall));
  if (all_valid && edgesOf(room, all_space).empty())
    value.error("enclose no space; the normal of each wall must point out of the room");
}

Room readRoom(ParamValue& element, std::set<std::string>& names) {
  Room room;
  readLocalName(element, room.name, names);
  if (auto walls = element.get("walls")) {
    const bool has_size = element.get("size").has_value(), has_pose = element.get("pose").has_value();
    if (has_size || has_pose)
      element.error("has walls, and size or pose; a room must have either walls, or a size and a pose");
    readWalls(*walls, room);
  } else {
    addWalls(readBox(element), room);
  }
  element.finish("field of a room (name, pose, size, walls)");
  return room;
}

/// Whether the opening has a point that is in the room, or within `kDoorRounding` of it.
bool reaches(const Eigen::AlignedBox3d& opening, const Room& room) {
  const Eigen::Vector3d center = opening.center(), half = 0.5 * opening.sizes();
  return std::all_of(room.walls.begin(), room.walls.end(), [&](const RoomWall& wall) {
    return wall.normal.dot(center) - wall.normal.cwiseAbs().dot(half) <= wall.offset + kDoorRounding;
  });
}

/// Reads the names of the two rooms of a door. @returns whether they are valid
bool readRoomNames(ParamValue& value, const std::vector<Room>& rooms, Portal& door) {
  std::vector<std::string> names;
  value.strings(names);
  if (names.size() != 2) {
    if (value.isList())
      value.error("has " + std::to_string(names.size()) + " names; it must have 2, those of the rooms on both sides");
    return false;
  }
  for (std::size_t side = 0; side < 2; ++side) {
    const auto named = [&](const Room& room) { return room.name == names[side]; };
    const auto found = std::find_if(rooms.begin(), rooms.end(), named);
    if (found == rooms.end()) {
      value.error("names '" + printable(names[side], 48) + "', which is not in ~rooms; correct the name");
      return false;
    }
    door.rooms[side] = static_cast<std::size_t>(found - rooms.begin());
  }
  if (names[0] == names[1]) value.error("names '" + names[0] + "' twice; a door must lead from a room to another one");
  return names[0] != names[1];
}

Portal readDoor(ParamValue& element, const std::vector<Room>& rooms) {
  Portal door;
  auto names = element.require("rooms");
  const bool has_rooms = names && readRoomNames(*names, rooms, door);
  const OrientedBox box = readBox(element);
  const Eigen::Vector3d half = 0.5 * box.world_from_box.linear().cwiseAbs() * box.size;
  const Eigen::Vector3d center = box.world_from_box.translation(), rounding = Eigen::Vector3d::Constant(kDoorRounding);
  door.opening = {center - half - rounding, center + half + rounding};
  element.finish("field of a door (rooms, pose, size)");
  for (const std::size_t room : door.rooms) {
    if (!has_rooms || box.size.isZero() || reaches(door.opening, rooms[room])) continue;
    element.error("does not reach the room '" + rooms[room].name +
                  "'; its box must go through the whole thickness of the wall");
  }
  return door;
}

}  // namespace

std::vector<Room> readRooms(ParamValue value) {
  std::vector<Room> rooms;
  std::set<std::string> names;
  std::vector<ParamValue> list = value.elements();
  checkCount(value, list.size(), kMostRooms, "rooms");
  if (list.size() > kMostRooms) return rooms;
  for (ParamValue& element : list) {
    if (element.requireStruct()) rooms.push_back(readRoom(element, names));
  }
  return rooms;
}

std::vector<Portal> readDoors(ParamValue value, const std::vector<Room>& rooms) {
  std::vector<Portal> doors;
  std::vector<ParamValue> list = value.elements();
  checkCount(value, list.size(), kMostDoors, "doors");
  if (list.size() > kMostDoors) return doors;
  for (ParamValue& element : list) {
    if (element.requireStruct()) doors.push_back(readDoor(element, rooms));
  }
  return doors;
}

}  // namespace hgrid
