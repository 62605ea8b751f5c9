// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#include "hgrid_proximity/broadphase/rooms.h"

#include <gtest/gtest.h>

#include <limits>

namespace hgrid {
namespace {

Eigen::AlignedBox3d boxOf(double x0, double y0, double x1, double y1) {
  return {Eigen::Vector3d(x0, y0, 0), Eigen::Vector3d(x1, y1, 3)};
}

/// Two rooms of 4 m x 4 m beside each other, with a wall of 0.2 m between them and a door in it. A third room of the
/// form of a wedge is apart.
Building building() {
  Room wedge = Room::ofBox("wedge", boxOf(20, 0, 24, 4));
  wedge.walls.push_back({Eigen::Vector3d(1, 1, 0), 24.0});
  return Building({Room::ofBox("west", boxOf(0, 0, 4, 4)), Room::ofBox("east", boxOf(4.2, 0, 8.2, 4)), wedge},
                  {{{0, 1}, boxOf(4, 1, 4.2, 2)}});
}

Aabb cube(float x, float y, float half = 0.3f) {
  return {{x - half, y - half, 1 - half}, {x + half, y + half, 1 + half}};
}

TEST(Rooms, ABoxIsInTheRoomsAndPortalsThatItOverlaps) {
  const Building rooms = building();
  const auto of = [&](const Aabb& box) {
    std::vector<std::uint32_t> found;
    rooms.roomsOf(box, found);
    return found;
  };
  EXPECT_EQ(of(cube(1, 1)), std::vector<std::uint32_t>({0}));
  EXPECT_EQ(of(cube(3.6f, 3)), std::vector<std::uint32_t>({0})) << "it only touches the wall";
  EXPECT_EQ(of(cube(4.1f, 3, 0.05f)), std::vector<std::uint32_t>()) << "it is inside the wall";
  EXPECT_EQ(of(cube(4.1f, 1.5f, 0.05f)), std::vector<std::uint32_t>({0, 1})) << "it is in the door";
  EXPECT_EQ(of(cube(4.1f, 3, 0.3f)), std::vector<std::uint32_t>({0, 1})) << "it reaches through the wall";
  EXPECT_EQ(of(cube(21, 1)), std::vector<std::uint32_t>({2}));
  EXPECT_EQ(of(cube(23.5f, 3.5f)), std::vector<std::uint32_t>()) << "the oblique wall cuts this corner off";
}

TEST(Rooms, AWrongBuildingIsRefusedByName) {
  const Room hall = Room::ofBox("hall", boxOf(0, 0, 1, 1)), other = Room::ofBox("other", boxOf(2, 0, 3, 1));
  const auto refusal = [](std::vector<Room> rooms, std::vector<Portal> portals) {
    try {
      Building(std::move(rooms), std::move(portals));
    } catch (const std::invalid_argument& error) {
      return std::string(error.what());
    }
    return std::string("accepted");
  };
  const Eigen::AlignedBox3d door = boxOf(1, 0, 2, 1);
  EXPECT_EQ(refusal({hall, other}, {{{0, 1}, door}}), "accepted");
  EXPECT_NE(refusal({hall, hall}, {}).find("'hall'"), std::string::npos);
  EXPECT_NE(refusal({{"bare", {}}}, {}).find("'bare' has no walls"), std::string::npos);
  EXPECT_NE(refusal({{"odd", {{Eigen::Vector3d::Zero(), 1.0}}}}, {}).find("'odd'"), std::string::npos);
  EXPECT_NE(refusal({{"far", {{Eigen::Vector3d::UnitX(), std::numeric_limits<double>::infinity()}}}}, {}).find("'far'"),
            std::string::npos);
  EXPECT_NE(refusal({hall, other}, {{{0, 2}, door}}).find("portal 0 leads to room 2"), std::string::npos);
  EXPECT_NE(refusal({hall, other}, {{{1, 1}, door}}).find("to itself"), std::string::npos);
  EXPECT_NE(refusal({hall, other}, {{{0, 1}, {}}}).find("portal 0 has an opening"), std::string::npos);
  EXPECT_NE(refusal(std::vector<Room>(Building::kMostRooms + 1, hall), {}).find("4097 rooms"), std::string::npos);
}

}  // namespace
}  // namespace hgrid
