// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

#include <array>
#include <string>
#include <vector>

#include "hgrid_proximity/broadphase/broad_phase_reader.h"

namespace hgrid {

/// A wall of a convex room. The room is on the side of the points p with normal . p <= offset.
struct RoomWall {
  Eigen::Vector3d normal = Eigen::Vector3d::UnitX();  ///< any length but 0
  double offset = 0.0;                                ///< [m] times the length of `normal`
};

/// A convex room: the points that are on the inner side of all walls.
struct Room {
  std::string name;             ///< different from the names of all other rooms
  std::vector<RoomWall> walls;  ///< at least one

  /// Returns a room in the form of a box.
  static Room ofBox(const std::string& name, const Eigen::AlignedBox3d& box);
};

/// An opening between two rooms, such as a door or a window.
struct Portal {
  std::array<std::size_t, 2> rooms{};  ///< indices of two different rooms
  Eigen::AlignedBox3d opening;         ///< [m] contains the opening, through the whole thickness of the wall
};

/// The rooms and portals of a building (Ericson, Real-Time Collision Detection, 2005, section 7.6).
///
/// A box is in every room that it overlaps, and in both rooms of every portal that it overlaps. Two boxes can form a
/// pair only if they have a room in common. So walls must be solid: two objects that meet inside a wall are not a pair.
/// Where two rooms overlap, there is no wall. A box that is in no room can form a pair with any box, because nothing is
/// known about its surroundings.
///
/// BodyRooms also needs pairs of bodies that are only near each other. For these, add a portal around the space where
/// two rooms overlap.
///
/// A box counts as in a room unless it is entirely on the outer side of one wall. So a box that overlaps the room
/// always counts. A box outside of the room, near one of its corners, may also count.
///
/// Differs from the book, whose section is about rendering and adds collisions in a remark:
/// - A portal is a box and not a polygon. It contains the whole thickness of the wall, so an object inside the opening
///   is in both rooms.
/// - There is no traversal from room to room. To locate a box, roomsOf() tests all rooms and all portals.
/// - The book tests an object against the objects of its cells. Here a broad phase finds all overlapping pairs, and
///   BodyRooms leaves out those of bodies without a common room.
class Building {
 public:
  static constexpr std::size_t kMostRooms = 4096;  ///< largest number of rooms

  /// @throws std::invalid_argument for a room without walls, a wall that is not finite or has no normal, a repeated
  ///   name, a portal to itself or to a room that does not exist, an empty opening, or too many rooms
  Building(std::vector<Room> rooms, std::vector<Portal> portals);

  /// Returns the rooms. Their indices are those of the constructor.
  const std::vector<Room>& rooms() const { return rooms_; }
  /// Returns the portals, in the order of the constructor.
  const std::vector<Portal>& portals() const { return portals_; }
  /// Replaces `found` with the indices of the rooms that a box is in, ascending.
  void roomsOf(const Aabb& box, std::vector<std::uint32_t>& found) const;

 private:
  std::vector<Room> rooms_;
  std::vector<Portal> portals_;
};

}  // namespace hgrid
