// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
//
// Cells and portals (Ericson, Real-Time Collision Detection, 2005, section 7.6).
#include "hgrid_proximity/broadphase/rooms.h"

#include <algorithm>
#include <cmath>
#include <set>
#include <stdexcept>

#include "geometry/rounding.h"

namespace hgrid {
namespace {

void require(bool holds, const std::string& what) {
  if (!holds) throw std::invalid_argument("Building: " + what);
}

/// Whether a box may overlap a room: for no wall of the room is the whole box on the outer side.
bool mayBeIn(const Room& room, const Aabb& box) {
  for (const RoomWall& wall : room.walls) {
    // `least` is the smallest value of normal . p over all points p of the box; `rounding` is the sum of the
    // absolute values of all terms.
    double least = 0.0, rounding = std::abs(wall.offset);
    for (int axis = 0; axis < 3; ++axis) {
      const double corner = wall.normal[axis] > 0.0 ? double(box.min[axis]) : double(box.max[axis]);
      least += wall.normal[axis] * corner;
      rounding += std::abs(wall.normal[axis] * corner);
    }
    if (least > wall.offset + gapRounding(rounding)) return false;
  }
  return true;
}

}  // namespace

Room Room::ofBox(const std::string& name, const Eigen::AlignedBox3d& box) {
  Room room{name, {}};
  for (int axis = 0; axis < 3; ++axis) {
    room.walls.push_back({Eigen::Vector3d::Unit(axis), box.max()[axis]});
    room.walls.push_back({-Eigen::Vector3d::Unit(axis), -box.min()[axis]});
  }
  return room;
}

Building::Building(std::vector<Room> rooms, std::vector<Portal> portals)
    : rooms_(std::move(rooms)), portals_(std::move(portals)) {
  require(rooms_.size() <= kMostRooms, "there are " + std::to_string(rooms_.size()) + " rooms; at most " +
                                           std::to_string(kMostRooms) + " are allowed");
  std::set<std::string> names;
  for (const Room& room : rooms_) {
    require(names.insert(room.name).second, "two rooms have the name '" + room.name + "'; names must differ");
    require(!room.walls.empty(), "room '" + room.name + "' has no walls; give it at least one");
    for (const RoomWall& wall : room.walls) {
      require(wall.normal.allFinite() && std::isfinite(wall.offset) && wall.normal.squaredNorm() > 0.0,
              "a wall of room '" + room.name + "' is not finite or has the normal 0; correct it");
    }
  }
  for (std::size_t i = 0; i < portals_.size(); ++i) {
    const Portal& portal = portals_[i];
    const std::string which = "portal " + std::to_string(i);
    for (const std::size_t room : portal.rooms)
      require(room < rooms_.size(), which + " leads to room " + std::to_string(room) + ", which does not exist");
    require(portal.rooms[0] != portal.rooms[1], which + " leads from a room to itself; name two different rooms");
    const bool is_open = portal.opening.min().allFinite() && portal.opening.max().allFinite() &&
                         (portal.opening.min().array() <= portal.opening.max().array()).all();
    require(is_open, which + " has an opening with min > max or a coordinate that is not finite; correct it");
  }
}

void Building::roomsOf(const Aabb& box, std::vector<std::uint32_t>& found) const {
  found.clear();
  for (std::uint32_t room = 0; room < rooms_.size(); ++room) {
    if (mayBeIn(rooms_[room], box)) found.push_back(room);
  }
  for (const Portal& portal : portals_) {
    if (!portal.opening.intersects(inDouble(box))) continue;
    for (const std::size_t room : portal.rooms) found.push_back(static_cast<std::uint32_t>(room));
  }
  std::sort(found.begin(), found.end());
  found.erase(std::unique(found.begin(), found.end()), found.end());
}

}  // namespace hgrid
