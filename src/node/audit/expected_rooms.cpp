// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#include "node/audit/expected_rooms.h"

namespace hgrid {
namespace {

/// Whether all corners of a box are beyond one wall of a room.
bool isBeyondAWall(const Room& room, const Eigen::AlignedBox3d& box) {
  for (const RoomWall& wall : room.walls) {
    int beyond = 0;
    for (int corner = 0; corner < 8; ++corner) {
      const Eigen::Vector3d point = box.corner(static_cast<Eigen::AlignedBox3d::CornerType>(corner));
      if (wall.normal.dot(point) > wall.offset) ++beyond;
    }
    if (beyond == 8) return true;
  }
  return false;
}

Eigen::AlignedBox3d grownBy(const Eigen::AlignedBox3d& box, double length) {
  return {box.min() - Eigen::Vector3d::Constant(length), box.max() + Eigen::Vector3d::Constant(length)};
}

bool haveCommon(const std::vector<bool>& a, const std::vector<bool>& b) {
  for (std::size_t room = 0; room < a.size(); ++room) {
    if (a[room] && b[room]) return true;
  }
  return false;
}

}  // namespace

/// Marks the rooms of a box, and the rooms of the doors that it reaches.
/// @param away   [m] how far the box may be from where it is
/// @param reach  [m] how far a door may be from it
/// @returns whether it is in a room or door
bool ExpectedRooms::listRooms(const Eigen::AlignedBox3d& box, double away, double reach,
                              std::vector<bool>& rooms) const {
  const Eigen::AlignedBox3d place = grownBy(box, away), reached = grownBy(box, reach);
  bool is_in = false;
  for (std::size_t room = 0; room < audited_.rooms.size(); ++room) {
    if (!isBeyondAWall(audited_.rooms[room], place)) rooms[room] = is_in = true;
  }
  for (const Portal& door : audited_.doors) {
    if (door.opening.exteriorDistance(reached) > 0.0) continue;
    for (const std::size_t room : door.rooms) rooms[room] = true;
    is_in = is_in || door.opening.exteriorDistance(place) <= 0.0;
  }
  return is_in;
}

ExpectedRooms::Found ExpectedRooms::look(std::uint32_t body) const {
  const RealBoxes& boxes = boxes_[body];
  Found found;
  found.surely.resize(audited_.rooms.size());
  found.possibly.resize(audited_.rooms.size());
  found.surely_anywhere = found.possibly_anywhere = boxes.shapes.empty() || !boxes.planes.empty();
  const double slack = roundingOf(audited_, boxes), away = filter_.growthOf(body), reach = filter_.shareOf(body);
  for (const Eigen::AlignedBox3d& box : boxes.shapes) {
    if (!listRooms(box, away - slack, reach - slack, found.surely)) found.possibly_anywhere = true;
    if (!listRooms(box, away + slack, reach + slack, found.possibly)) found.surely_anywhere = true;
  }
  return found;
}

const ExpectedRooms::Found& ExpectedRooms::of(std::uint32_t body) {
  if (!known_[body]) known_[body] = look(body);
  return *known_[body];
}

bool ExpectedRooms::surelyJoined(std::uint32_t first, std::uint32_t second) {
  if (audited_.rooms.empty()) return true;
  const Found &a = of(first), &b = of(second);
  if (haveCommon(a.surely, b.surely)) return true;
  return audited_.horizon == 0.0 && (a.surely_anywhere || b.surely_anywhere);  // the horizon grows boxes further
}

bool ExpectedRooms::surelySeparate(std::uint32_t first, std::uint32_t second) {
  if (audited_.rooms.empty() || audited_.horizon > 0.0) return false;
  const Found &a = of(first), &b = of(second);
  return !a.possibly_anywhere && !b.possibly_anywhere && !haveCommon(a.possibly, b.possibly);
}

}  // namespace hgrid
